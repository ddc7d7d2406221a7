/// \file
/// A stop watch for the stages of a step.
#ifndef TAFONI_WEATHERING_DETAIL_LAP_CLOCK_HPP
#define TAFONI_WEATHERING_DETAIL_LAP_CLOCK_HPP

#include <chrono>

namespace tafoni::detail {

/// Seconds, lap by lap.
class lap_clock {
public:
    void into(double& sum) noexcept {
        auto const t = std::chrono::steady_clock::now();
        sum += std::chrono::duration<double>(t - last_).count();
        last_ = t;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace tafoni::detail

#endif
