/// \file
/// The bytes that a frost run is saved as and goes on from.
#ifndef TAFONI_WEATHERING_FROST_CHECKPOINT_HPP
#define TAFONI_WEATHERING_FROST_CHECKPOINT_HPP

#include <tafoni/weathering/detail/checkpoint_bytes.hpp>
#include <tafoni/weathering/detail/frost_core.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tafoni::detail {

/// Cells, links and geometry that a state belongs to. O(links).
template <class Network>
[[nodiscard]] std::uint64_t network_hash(link_table<Network> const& table, std::span<std::int64_t const> volumes) {
    number_hash h;
    h.add(static_cast<std::uint64_t>(table.size()));
    for (std::int64_t const v : volumes) h.add(static_cast<std::uint64_t>(v));
    for (std::size_t i = 0; i < table.size(); ++i) {
        link_record const& r = table[link_index{i}];
        for (double const v : {r.x, r.y, r.z, r.area}) h.add(v);
        h.add(std::uint64_t{r.cells[0].value} << 32 | r.cells[1].value);
    }
    return h.value();
}

/// Options, all policies, the exposure, and the resistance as read. O(links).
template <class Network, class Process, class Exposure>
[[nodiscard]] std::uint64_t parameter_hash(frost_core<Network, Process, Exposure> const& core) {
    number_hash h;
    h.add(core.options.water);
    h.add(core.options.seed);
    h.add(static_cast<std::uint64_t>(core.options.mean));
    h.add(static_cast<std::uint64_t>(core.options.longest_path));
    auto const add = [&h](auto const& policy) { add_policy(h, policy); };
    visit_policies(core.process, add);
    visit_policies(core.exposure, add);
    for (std::size_t i = 0; i < core.table.size(); ++i) h.add(core.table[link_index{i}].resistance);
    return h.value();
}

inline constexpr std::uint64_t checkpoint_magic = 0x6F72662D66617400ULL;  // "\0taf-fro"
inline constexpr std::uint64_t checkpoint_version = 1;

/// Magic, version, hash of the network, hash of the parameters, counters, cells, marks, link states, lives,
/// blocks, hash.
template <class Network, class Process, class Exposure>
[[nodiscard]] std::vector<std::byte> write_checkpoint(frost_core<Network, Process, Exposure> const& core) {
    frost_state const& s = core.state;
    byte_writer out;
    out.reserve(256 + s.cells.size() * 2 + core.table.size() * 9);
    out.put(checkpoint_magic);
    out.put(checkpoint_version, 4);
    out.put(network_hash(core.table, s.volumes));
    out.put(parameter_hash(core));
    out.put(s.cells.size());
    out.put(core.table.size());
    frost_counters const& c = s.count;
    for (std::uint64_t const v : {c.paths, c.without_entry, c.traversed, c.links_broken, c.cells_detached}) out.put(v);
    out.put(static_cast<std::uint64_t>(c.volume_detached));
    for (wide_int const v : {c.water.inflow, c.water.absorbed, c.water.lost, c.water.drained}) out.put(v);
    for (cell_state const v : s.cells) out.put(static_cast<std::uint64_t>(v), 1);
    for (cell_state const v : s.marks) out.put(static_cast<std::uint64_t>(v), 1);
    for (link_state const v : core.states) out.put(static_cast<std::uint64_t>(v), 1);
    for (std::size_t i = 0; i < core.table.size(); ++i) {
        out.put(std::bit_cast<std::uint64_t>(core.table[link_index{i}].life));
    }
    out.put(s.blocks.size());
    for (detached_block const& b : s.blocks) {
        out.put(b.path);
        out.put(b.cells.size());
        for (cell_index const cell : b.cells) out.put(cell.value, 4);
    }
    out.put(byte_hash(out.bytes()));
    return std::move(out.bytes());
}

/// Reads all, checks all, and only then changes `core`.
template <class Network, class Process, class Exposure>
void read_checkpoint(frost_core<Network, Process, Exposure>& core, std::span<std::byte const> bytes) {
    auto const bad = [](char const* why) {
        fail<io_error>(errc::bad_syntax, std::string("frost_run::resume: ") + why);
    };
    byte_reader in(bytes, "frost_run::resume");
    if (bytes.size() < 8 || in.get() != checkpoint_magic) {
        fail<io_error>(errc::wrong_format, "frost_run::resume: these bytes are no frost checkpoint");
    }
    if (std::uint64_t const version = in.get(4); version != checkpoint_version) {
        fail<io_error>(errc::unsupported, "frost_run::resume: checkpoint version " + std::to_string(version) +
                                              ", this library reads " + std::to_string(checkpoint_version));
    }
    frost_state s = core.state;
    if (in.get() != network_hash(core.table, s.volumes)) {
        fail<io_error>(errc::checkpoint_mismatch, "frost_run::resume: the checkpoint belongs to another network");
    }
    if (in.get() != parameter_hash(core)) {
        fail<io_error>(errc::checkpoint_mismatch, "frost_run::resume: the checkpoint was made with other parameters");
    }
    if (in.get() != s.cells.size() || in.get() != core.table.size()) bad("the counts do not fit the network");
    frost_counters& c = s.count;
    for (std::uint64_t* v : {&c.paths, &c.without_entry, &c.traversed, &c.links_broken, &c.cells_detached}) {
        *v = in.get();
    }
    c.volume_detached = static_cast<std::int64_t>(in.get());
    for (wide_int* v : {&c.water.inflow, &c.water.absorbed, &c.water.lost, &c.water.drained}) {
        *v = in.get_wide();
        if (*v < 0 || *v >> 122 != 0) bad("an amount of water is out of range");
    }
    if (c.water.inflow != c.water.absorbed + c.water.lost + c.water.drained) bad("the water does not add up");
    for (auto* list : {&s.cells, &s.marks}) {
        for (cell_state& v : *list) {
            std::uint64_t const b = in.get(1);
            if (b > 2) bad("a cell state is out of range");
            v = static_cast<cell_state>(b);
        }
    }
    std::vector<link_state> states(core.table.size());
    for (link_state& v : states) {
        std::uint64_t const b = in.get(1);
        if (b > static_cast<std::uint64_t>(link_state::gone)) bad("a link state is out of range");
        v = static_cast<link_state>(b);
    }
    std::vector<double> lives(core.table.size());
    for (double& v : lives) {
        v = std::bit_cast<double>(in.get());
        if (!(v >= 0 && v <= 1)) bad("a life is outside [0, 1]");
    }
    s.blocks.clear();
    std::vector<bool> fallen(s.cells.size(), false);
    std::int64_t all = 0;
    std::uint64_t const blocks = in.get();
    for (std::uint64_t k = 0; k < blocks; ++k) {
        detached_block b;
        b.path = in.get();
        std::uint64_t const n = in.get();
        if (n > in.left() / 4) bad("a block has more cells than there are bytes");
        std::int64_t volume = 0;
        for (std::uint64_t j = 0; j < n; ++j) {
            cell_index const cell{static_cast<std::uint32_t>(in.get(4))};
            if (cell.value >= s.cells.size()) bad("a block names a cell that does not exist");
            if (s.cells[cell.value] != cell_state::air || fallen[cell.value]) bad("a cell fell twice, or not at all");
            if (j > 0 && !(b.cells.back() < cell)) bad("the cells of a block are not ascending");
            fallen[cell.value] = true;
            volume += s.volumes[cell.value];
            b.cells.push_back(cell);
        }
        b.volume = from_fixed(volume, s.total_volume);
        all += volume;
        s.blocks.push_back(std::move(b));
    }
    auto const gone = static_cast<std::uint64_t>(std::count(fallen.begin(), fallen.end(), true));
    if (all != c.volume_detached || gone != c.cells_detached) bad("the blocks do not add up");
    std::uint64_t const expected = byte_hash(bytes.first(bytes.size() - in.left()));
    if (in.get() != expected) bad("the checksum is wrong");
    if (in.left() != 0) bad("bytes follow the end");
    auto const exchange = [&] {
        core.dirty = true;
        std::swap(core.state, s);
        core.states.swap(states);
        for (std::size_t i = 0; i < lives.size(); ++i) std::swap(core.table[link_index{i}].life, lives[i]);
    };
    exchange();
    try {
        core.rebuild();
    } catch (...) {  // out of memory: as before, and the next call rebuilds
        exchange();
        throw;
    }
}

}  // namespace tafoni::detail

#endif
