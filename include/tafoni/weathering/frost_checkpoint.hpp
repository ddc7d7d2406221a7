/// \file
/// The bytes that a frost run is saved as and goes on from.
#ifndef TAFONI_WEATHERING_FROST_CHECKPOINT_HPP
#define TAFONI_WEATHERING_FROST_CHECKPOINT_HPP

#include <tafoni/weathering/detail/frost_core.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tafoni::detail {

/// A 64-bit hash of numbers, the same everywhere; not against malice.
class number_hash {
public:
    void add(std::uint64_t v) noexcept {
        h_ = (h_ ^ v) * 0x9E3779B97F4A7C15ULL;
        h_ ^= h_ >> 29;
    }
    void add(double v) noexcept { add(std::bit_cast<std::uint64_t>(v == 0 ? 0.0 : v)); }
    [[nodiscard]] std::uint64_t value() const noexcept {
        std::uint64_t h = h_ * 0xBF58476D1CE4E5B9ULL;
        return h ^ h >> 32;
    }

private:
    std::uint64_t h_ = 0x7461666F6E690001ULL;
};

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

/// What tells two policies apart without help of the compiler's names, which differ between compilers.
/// An empty policy has a size of 1 and no bytes that say anything.
template <class Policy>
void add_policy(number_hash& h, Policy const& policy) {
    if constexpr (requires { policy.parameters(); }) {
        for (double const v : policy.parameters()) h.add(v);
    } else if constexpr (std::is_trivially_copyable_v<Policy> && std::has_unique_object_representations_v<Policy> &&
                         !std::is_empty_v<Policy>) {
        for (auto const byte : std::bit_cast<std::array<unsigned char, sizeof(Policy)>>(policy)) {
            h.add(std::uint64_t{byte});
        }
    }
    if constexpr (requires { std::string_view(Policy::name); }) {
        for (char const c : std::string_view(Policy::name)) h.add(std::uint64_t{static_cast<unsigned char>(c)});
    } else {
        h.add(std::uint64_t{sizeof(Policy)});
    }
    h.add(std::uint64_t{0x5EA});
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

/// Little-endian bytes, whatever the machine.
class byte_writer {
public:
    void put(std::uint64_t v, int bytes = 8) {
        for (int k = 0; k < bytes; ++k) bytes_.push_back(static_cast<std::byte>(v >> (8 * k) & 0xFF));
    }
    void put(wide_int v) {
        put(static_cast<std::uint64_t>(v));
        put(static_cast<std::uint64_t>(v >> 64));
    }
    void reserve(std::size_t n) { bytes_.reserve(n); }
    [[nodiscard]] std::vector<std::byte>& bytes() noexcept { return bytes_; }

private:
    std::vector<std::byte> bytes_{};
};

class byte_reader {
public:
    explicit byte_reader(std::span<std::byte const> bytes) noexcept : bytes_(bytes) {}
    [[nodiscard]] std::uint64_t get(std::size_t bytes = 8) {
        if (bytes_.size() - at_ < bytes) fail<io_error>(errc::truncated, "frost_run::resume: the checkpoint ends early");
        std::uint64_t v = 0;
        for (std::size_t k = 0; k < bytes; ++k) v |= std::to_integer<std::uint64_t>(bytes_[at_ + k]) << (8 * k);
        at_ += bytes;
        return v;
    }
    [[nodiscard]] wide_int get_wide() {
        std::uint64_t const low = get();
        auto const high = static_cast<std::int64_t>(get());
        return wide_int{high} * (wide_int{1} << 64) + static_cast<wide_int>(low);
    }
    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - at_; }

private:
    std::span<std::byte const> bytes_;
    std::size_t at_ = 0;
};

inline constexpr std::uint64_t checkpoint_magic = 0x6F72662D66617400ULL;  // "\0taf-fro"
inline constexpr std::uint64_t checkpoint_version = 1;

[[nodiscard]] inline std::uint64_t byte_hash(std::span<std::byte const> bytes) noexcept {
    number_hash h;
    std::size_t k = 0;
    for (; k + 8 <= bytes.size(); k += 8) {
        std::uint64_t v = 0;
        for (std::size_t j = 0; j < 8; ++j) v |= std::to_integer<std::uint64_t>(bytes[k + j]) << (8 * j);
        h.add(v);
    }
    for (; k < bytes.size(); ++k) h.add(std::to_integer<std::uint64_t>(bytes[k]));
    return h.value();
}

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
    byte_reader in(bytes);
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
