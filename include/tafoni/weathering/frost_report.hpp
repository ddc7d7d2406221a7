/// \file
/// What a frost run takes and what it tells.
#ifndef TAFONI_WEATHERING_FROST_REPORT_HPP
#define TAFONI_WEATHERING_FROST_REPORT_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/percolation/percolate.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace tafoni {

/// Which links the mean area runs over that scales the coefficients.
enum class area_mean : std::uint8_t {
    interior,  ///< the paper's: bonds only
    all,       ///< the authors' add-on's: skin links too
};

/// What is fixed over a run, unless replaced between paths.
struct frost_options {
    double water = 1;                       ///< w_in of a path, in [0, 1024]; 0: paths change nothing
    std::uint64_t seed = 0;
    area_mean mean = area_mean::interior;
    std::uint32_t longest_path = 1u << 20;  ///< links after which the rest of a path's water is lost, >= 1

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("frost_options.water", water, 0, water_unit::limit);
        detail::require_range("frost_options.longest_path", longest_path, 1, 4294967295.0);
    }
};

/// What ends a run early.
enum class stop_when : std::uint8_t {
    never,             ///< where no skin is left, the remaining paths are booked without entry, at once
    first_break,
    first_detachment,
    nothing_enters,    ///< no skin is left where rain could enter
};

/// Why a run ended.
enum class stop_reason : std::uint8_t { finished, first_break, first_detachment, observer, nothing_enters };

/// One call of `run`.
struct frost_schedule {
    std::uint64_t paths = 0;            ///< how many paths to add
    std::uint32_t batch = 1;            ///< paths that walk one frozen state, >= 1; 1 is the sequential process
    stop_when stop = stop_when::never;  ///< looked at after each batch
    std::uint64_t snapshot_every = 0;   ///< calls `on_snapshot` when the number of paths is a multiple; 0 never
    std::function<step_control(std::uint64_t paths)> on_snapshot{};  ///< `stop` ends the run after this path

    /// \throws invalid_input  `bad_parameter`.
    void validate() const { detail::require_range("frost_schedule.batch", batch, 1, 1u << 24); }
};

/// A part that fell.
struct detached_block {
    std::uint64_t path = 0;           ///< number of paths that were complete when it fell, that one included
    std::vector<cell_index> cells{};  ///< ascending
    double volume = 0;                ///< cubed length unit
};

/// Totals since the start (or the last `reset`). Equal runs give equal reports but for `seconds`.
struct frost_report {
    std::uint64_t paths = 0;
    std::uint64_t paths_without_entry = 0;  ///< no link accepted the rain
    std::uint64_t links_traversed = 0;
    std::uint64_t links_broken = 0;         ///< worn or broken by chance; not those of cells that fell
    std::uint64_t cells_detached = 0;
    std::uint64_t blocks = 0;
    double water_in = 0;                    ///< w_in of all paths that entered
    double water_absorbed = 0;              ///< by links
    double water_lost = 0;                  ///< soaked without wearing; met a link that broke in the same batch
    double water_drained = 0;               ///< left where no way led on
    double volume_detached = 0;             ///< cubed length unit
    struct stage_seconds {
        double run = 0;     ///< all of `run`; what the other two leave is wear and books
        double walk = 0;    ///< water on its way; in batches of less than 16 estimated from one in 16
        double detach = 0;  ///< connectivity, falling parts and exposure
    } seconds{};
    stop_reason stopped = stop_reason::finished;  ///< of the last `run`
};

}  // namespace tafoni

#endif
