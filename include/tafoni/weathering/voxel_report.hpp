/// \file
/// What a voxel run takes and what it tells.
#ifndef TAFONI_WEATHERING_VOXEL_REPORT_HPP
#define TAFONI_WEATHERING_VOXEL_REPORT_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tafoni {

/// What the rate function is asked at: v is the share of air in the bubble.
///
/// The centre of a voxel at a flat surface lies half a voxel inside the rock, so v is less than one half there: by
/// about 0.4 / r in a sphere of radius r, much more in thin bubbles. `signed_excess` takes that for a hollow, and flat
/// rock recedes under cavernous weathering; `flat_excess` measures from there.
enum class curvature_measure : std::uint8_t {
    air_share,      ///< the paper's: v for spheroidal, 1 - v for cavernous weathering
    signed_excess,  ///< max(0, 2 v - 1) and max(0, 1 - 2 v): over and under one half
    /// max(0, v - h) / (1 - h) and max(0, l - v) / l, where l is the least and h the greatest share that flat ground,
    /// walls and ceilings square to the axes show in the bubble: they neither round nor hollow.
    flat_excess
};

/// Some steps under the same processes.
struct voxel_phase {
    std::uint64_t steps = 1;
    double spheroidal = 1;  ///< A, in [0, 1e6]; 0: not at work
    double cavernous = 0;   ///< B, in [0, 1e6]; 0: not at work
};

/// How time goes on within a step. The two agree the better, the smaller the steps: cut into 64 parts, they differ by
/// less than one per cent of the voxels that fell (tests/weathering/voxel_laws.test.cpp).
enum class voxel_clock : std::uint8_t {
    steps,  ///< all that is used up within a step falls at its end
    events  ///< a voxel falls at the time at which it is used up, and its neighbours weather faster from then on
};

/// One call of `run`: phases, one after the other.
///
/// Figure 10 is {.phases = {{.steps = 17, .spheroidal = 0, .cavernous = 1}, {.steps = 1},
///                          {.steps = 2, .spheroidal = 0, .cavernous = 1}}}.
struct voxel_schedule {
    std::vector<voxel_phase> phases{};
    voxel_clock clock = voxel_clock::steps;
    std::uint64_t snapshot_every = 0;  ///< calls `on_snapshot` when the number of steps is a multiple; 0 never
    std::function<step_control(std::uint64_t steps)> on_snapshot{};  ///< `stop` ends the run after this step

    /// Steps in all phases; `validate` asks for 2^62 at most.
    [[nodiscard]] std::uint64_t steps() const noexcept {
        std::uint64_t sum = 0;
        for (voxel_phase const& p : phases) sum += p.steps;
        return sum;
    }
    /// What is left of the schedule when its first `done` steps are done: for going on from a checkpoint.
    [[nodiscard]] voxel_schedule after(std::uint64_t done) const {
        voxel_schedule rest = *this;
        rest.phases.clear();
        for (voxel_phase p : phases) {
            std::uint64_t const gone = done < p.steps ? done : p.steps;
            done -= gone;
            p.steps -= gone;
            if (p.steps > 0) rest.phases.push_back(p);
        }
        return rest;
    }
    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        double sum = 0;
        for (std::size_t k = 0; k < phases.size(); ++k) {
            std::string const at = "voxel_schedule.phases[" + std::to_string(k) + "].";
            detail::require_range((at + "spheroidal").c_str(), phases[k].spheroidal, 0, 1e6);
            detail::require_range((at + "cavernous").c_str(), phases[k].cavernous, 0, 1e6);
            sum += static_cast<double>(phases[k].steps);
            detail::require_range((at + "steps").c_str(), sum, 0, 0x1p62);
        }
    }
};

/// Why a voxel run ended.
enum class voxel_stop : std::uint8_t { finished, observer };

/// Totals since the start. Equal runs give equal reports but for `seconds`.
/// voxels_rock + voxels_colluvium + voxels_vanished + voxels_fallen + voxels_left = voxels_initial, always.
struct voxel_report {
    std::uint64_t steps = 0;
    std::uint64_t voxels_initial = 0;    ///< rock and colluvium of the input
    std::uint64_t voxels_rock = 0;       ///< now
    std::uint64_t voxels_colluvium = 0;  ///< now
    std::uint64_t voxels_vanished = 0;   ///< weathered away: colluvium, and rock where no colluvium is made
    std::uint64_t voxels_fallen = 0;     ///< with blocks of rock that came loose
    std::uint64_t voxels_left = 0;       ///< slid beyond an open border
    std::uint64_t surface_voxels = 0;    ///< skin now: what weathers
    std::uint64_t blocks = 0;            ///< that fell
    struct stage_seconds {
        double run = 0;       ///< all of `run`
        double weather = 0;   ///< decay and removal
        double rockfall = 0;
        double settle = 0;
        double notify = 0;    ///< counts, new skin
    } seconds{};
    voxel_stop stopped = voxel_stop::finished;  ///< of the last `run`
};

}  // namespace tafoni

#endif
