/// \file
/// Equal intervals of a field's range, and checks that mixtures and profiles of bubbles share.
#ifndef TAFONI_VOXEL_DETAIL_EQUAL_INTERVAL_HPP
#define TAFONI_VOXEL_DETAIL_EQUAL_INTERVAL_HPP

#include <tafoni/core/error.hpp>

#include <cstddef>
#include <string>

namespace tafoni::detail {

/// Of n equal intervals of [lowest, highest] the one that holds the value, those at the ends being open; NaN: the
/// first.
[[nodiscard]] inline std::size_t equal_interval(double value, double lowest, double highest, std::size_t n) noexcept {
    double const share = (value - lowest) / (highest - lowest);
    if (!(share > 0)) return 0;
    if (share >= 1) return n - 1;
    auto const k = static_cast<std::size_t>(share * static_cast<double>(n));
    return k < n ? k : n - 1;
}

inline void require_bubbles(char const* name, std::size_t n) {
    if (n == 0) {
        fail<invalid_input>(errc::empty_input, std::string(name) + ": got none, need at least 1",
                            {.kind = entity::parameter, .value = 0, .limit = 1});
    }
    if (n > 65536) {
        fail<invalid_input>(errc::size_overflow, std::string(name) + ": got " + std::to_string(n) + ", at most 65536",
                            {.kind = entity::parameter, .value = static_cast<double>(n), .limit = 65536});
    }
}

inline void require_interval(std::string const& owner, double lowest, double highest) {
    require_range((owner + ".lowest").c_str(), lowest, -1e150, 1e150);
    require_range((owner + ".highest").c_str(), highest, -1e150, 1e150);
    if (!(lowest < highest)) {
        fail<invalid_input>(
            errc::bad_parameter,
            owner + ".highest: got " + number_text(highest) + ", needs more than lowest, " + number_text(lowest),
            {.kind = entity::parameter, .value = highest, .limit = lowest});
    }
}

}  // namespace tafoni::detail

#endif
