/// \file
/// Of the two parts of a split the smaller one falls, unless a core cell holds it.
#ifndef TAFONI_RULES_SMALLER_PART_FALLS_HPP
#define TAFONI_RULES_SMALLER_PART_FALLS_HPP

#include <tafoni/rules/concepts.hpp>

namespace tafoni {

/// Both parts hold core cells: neither falls. One does: the other falls. None does: the smaller volume
/// falls, on a tie the part without the lowest cell id [Mateos et al., section 5.3 and Figure 11].
/// Models `detachment_rule`.
struct smaller_part_falls {
    /// O(1).
    [[nodiscard]] falling decide(part const& a, part const& b) const noexcept {
        if (a.core_cells > 0 && b.core_cells > 0) return falling::neither;
        if (a.core_cells > 0) return falling::second;
        if (b.core_cells > 0) return falling::first;
        if (a.volume != b.volume) return a.volume < b.volume ? falling::first : falling::second;
        return a.lowest_cell < b.lowest_cell ? falling::second : falling::first;
    }
};

static_assert(detachment_rule<smaller_part_falls>);

}  // namespace tafoni

#endif
