/// \file
/// What a frost run remembers: everything else is derived from it.
#ifndef TAFONI_WEATHERING_DETAIL_FROST_STATE_HPP
#define TAFONI_WEATHERING_DETAIL_FROST_STATE_HPP

#include <tafoni/core/sum.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/weathering/frost_report.hpp>

#include <limits>
#include <string>
#include <vector>

namespace tafoni::detail {

__extension__ using wide_int = __int128;

/// Whole water units over all paths: inflow = absorbed + lost + drained, always.
struct water_ledger {
    wide_int inflow = 0;
    wide_int absorbed = 0;
    wide_int lost = 0;
    wide_int drained = 0;
};

[[nodiscard]] inline double water_of(wide_int units) noexcept {
    std::int64_t const whole = static_cast<std::int64_t>(units >> 48);
    auto const rest = static_cast<std::int64_t>(units & ((wide_int{1} << 48) - 1));
    return static_cast<double>(whole) + static_cast<double>(rest) * 0x1p-48;
}

/// Counters that only grow while paths are walked.
struct frost_counters {
    std::uint64_t paths = 0;
    std::uint64_t without_entry = 0;
    std::uint64_t traversed = 0;
    std::uint64_t links_broken = 0;
    std::uint64_t cells_detached = 0;
    std::int64_t volume_detached = 0;  ///< units of 2^-52 of the network's volume
    water_ledger water{};
};

/// Cells, marks, counters and what fell. Lives stand in the link table.
struct frost_state {
    std::vector<cell_state> cells{};
    std::vector<cell_state> marks{};      ///< set by hand; what `reset` goes back to
    std::vector<std::int64_t> volumes{};  ///< per cell, units of 2^-52 of the network's volume
    double total_volume = 1;
    frost_counters count{};
    std::vector<detached_block> blocks{};

    template <class Network>
    explicit frost_state(Network const& network)
        : cells(network.cell_count(), cell_state::solid), marks(cells), volumes(cells.size(), 0) {
        for (std::size_t c = 0; c < cells.size(); ++c) {
            double const v = network.cell_volume(cell_index{c});
            if (!(v > 0 && v <= std::numeric_limits<double>::max())) {
                fail<invalid_input>(errc::out_of_range,
                                    "frost_run: cell " + std::to_string(c) + " has volume " + number_text(v),
                                    {.kind = entity::cell, .index = c, .value = v, .limit = 0});
            }
        }
        double const sum =
            pairwise_sum(0, cells.size(), [&](std::size_t c) { return network.cell_volume(cell_index{c}); });
        if (sum > 0) total_volume = sum;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            volumes[c] = to_fixed(network.cell_volume(cell_index{c}), total_volume);
        }
    }

    void reset() noexcept {
        cells = marks;
        count = {};
        blocks.clear();
    }

    [[nodiscard]] frost_report report() const noexcept {
        frost_report r;
        r.paths = count.paths;
        r.paths_without_entry = count.without_entry;
        r.links_traversed = count.traversed;
        r.links_broken = count.links_broken;
        r.cells_detached = count.cells_detached;
        r.blocks = blocks.size();
        r.water_in = water_of(count.water.inflow);
        r.water_absorbed = water_of(count.water.absorbed);
        r.water_lost = water_of(count.water.lost);
        r.water_drained = water_of(count.water.drained);
        r.volume_detached = from_fixed(count.volume_detached, total_volume);
        return r;
    }
};

}  // namespace tafoni::detail

#endif
