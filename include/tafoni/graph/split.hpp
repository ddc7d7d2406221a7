/// \file
/// What a component of the cells graph comes apart into.
#ifndef TAFONI_GRAPH_SPLIT_HPP
#define TAFONI_GRAPH_SPLIT_HPP

#include <tafoni/graph/concepts.hpp>

#include <array>
#include <cstdint>

namespace tafoni {

/// A piece that came off, or what is left of the one it came off from.
struct fragment {
    part totals{};
    std::uint32_t component = 0;  ///< for `cells_of` and `remove_component`
    std::uint32_t group = 0;      ///< fragments of one former component share it; ascending from 0
};

/// The two parts that a broken link leaves; the first holds `link_cells(l)[0]`.
struct split {
    part first{};
    part second{};
    std::array<std::uint32_t, 2> components{};
};

}  // namespace tafoni

#endif
