/// \file
/// A draw from the normal distribution with the same bits on every machine.
#ifndef TAFONI_CORE_RANDOM_NORMAL_HPP
#define TAFONI_CORE_RANDOM_NORMAL_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>

namespace tafoni {

/// Normal with mean 0 and variance 1, by the polar method [Marsaglia, Bray 1964]. Takes an even,
/// varying number of draws from `random`. O(1) expected.
[[nodiscard]] inline double random_normal(stream& random) noexcept {
    for (;;) {
        double const u = random.uniform(-1, 1);
        double const v = random.uniform(-1, 1);
        double const s = u * u + v * v;
        if (s > 0 && s < 1) return u * std::sqrt(-2 * elementary::log(s) / s);
    }
}

}  // namespace tafoni

#endif
