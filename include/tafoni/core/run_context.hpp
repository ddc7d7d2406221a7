/// \file
/// Progress, cancel and finish-early for every algorithm that takes longer than a moment.
#ifndef TAFONI_CORE_RUN_CONTEXT_HPP
#define TAFONI_CORE_RUN_CONTEXT_HPP

#include <tafoni/core/error.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace tafoni {

/// An observer's answer: go on, or stop. What a stop keeps is for each algorithm to say: a run keeps what
/// is done, an algorithm whose part results are of no use throws `cancelled`.
enum class step_control { proceed, stop };

/// Told at least once at the start (fraction 0) and at the end (1) of each stage; never decreases in a stage.
struct progress_event {
    std::string_view stage;  ///< name of the stage, in order of the algorithm's documentation
    double fraction = 0;     ///< done part of the stage, in [0, 1]
};

/// What a caller may hang onto an algorithm. A default-constructed one costs a branch per tick.
struct run_context {
    std::function<step_control(progress_event const&)> on_progress{};

    /// Reports; throws `cancelled` when the observer says stop. For algorithms whose part results are of no use.
    void tick(std::string_view stage, double fraction) const {
        if (on_progress && on_progress({stage, fraction}) == step_control::stop) {
            std::string what(stage);
            what += ": cancelled";
            detail::fail<cancelled>(errc::cancelled, what);
        }
    }
};

}  // namespace tafoni

#endif
