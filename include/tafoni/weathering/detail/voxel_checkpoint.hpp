/// \file
/// The bytes that a voxel run is saved as and goes on from.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_CHECKPOINT_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_CHECKPOINT_HPP

#include <tafoni/weathering/detail/checkpoint_bytes.hpp>
#include <tafoni/weathering/detail/voxel_core.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

inline constexpr std::uint64_t voxel_checkpoint_magic = 0x786F762D66617400ULL;  // "\0taf-vox"
inline constexpr std::uint64_t voxel_checkpoint_version = 1;

/// Bubbles, rates and options; durability is that of the skin, in `skin_hash`. O(rows and sizes of the bubbles).
template <class Process>
[[nodiscard]] std::uint64_t parameter_hash(voxel_core<Process> const& core) {
    number_hash h;
    voxel_options const& o = core.options;
    for (auto const v : {static_cast<std::uint64_t>(o.measure), static_cast<std::uint64_t>(o.skin_depth), o.seed}) h.add(v);
    h.add(std::uint64_t{o.colluvium ? 1u : 0u});
    if (o.colluvium) {
        h.add(o.colluvium->angle);
        h.add(static_cast<std::uint64_t>(o.colluvium->baseline));
    }
    h.add(std::uint64_t{o.rockfall ? 1u : 0u});
    if (o.rockfall) {
        for (ground_side const s : o.rockfall->sides) h.add(static_cast<std::uint64_t>(s));
        for (voxel const v : o.rockfall->ground_voxels) {
            for (std::int32_t const x : {v.x, v.y, v.z}) h.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)));
        }
        h.add(std::uint64_t{o.rockfall->ground_where ? 1u : 0u});
        h.add(o.rockfall->friction_angle);
        for (joint_disc const& d : o.rockfall->joints.discs) {
            for (Eigen::Index k = 0; k < 3; ++k) {
                h.add(d.centre[k]);
                h.add(d.normal[k]);
            }
            h.add(d.radius);
        }
    }
    for (bubble_stencil const& s : core.stencils()) h.add(s.fingerprint());
    for (auto const table : {core.rates.spheroidal_table(), core.rates.cavernous_table()}) {
        for (double const r : table) h.add(r);
    }
    return h.value();
}

/// Slots that hold anything, by brick.
[[nodiscard]] inline std::vector<std::size_t> slots_by_brick(voxel_skins const& skins) {
    std::vector<std::size_t> out;
    for (std::size_t s = 0; s < skins.size(); ++s) {
        if (skins[s].size() + skins[s].covered.size() > 0) out.push_back(s);
    }
    std::sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return skins.brick(a) < skins.brick(b); });
    return out;
}

/// Bubbles and durability of the skin, as the policies answered. O(skin).
[[nodiscard]] inline std::uint64_t skin_hash(voxel_skins const& skins) {
    number_hash h;
    for (std::size_t const s : slots_by_brick(skins)) {
        for (std::size_t i = 0; i < skins[s].size(); ++i) {
            h.add(std::uint64_t{skins[s].position[i]} << 16 | skins[s].bubble[i]);
            h.add(skins[s].durability[i]);
        }
    }
    return h.value();
}

/// Magic, version, hashes of the first grid and of the parameters, totals, bricks, hash of the skin, what is left of
/// its voxels, blocks, hash. The time within a step must be 0.
template <class Process>
[[nodiscard]] std::vector<std::byte> write_checkpoint(voxel_core<Process> const& core) {
    byte_writer out;
    out.reserve(1024 + core.grid.bytes() + core.count.surface_voxels * 10);
    out.put(voxel_checkpoint_magic);
    out.put(voxel_checkpoint_version, 4);
    out.put(core.first_grid);
    out.put(parameter_hash(core));
    voxel_report const& c = core.count;
    for (std::uint64_t const v : {c.steps, c.voxels_rock, c.voxels_colluvium, c.voxels_vanished, c.voxels_fallen, c.voxels_left}) {
        out.put(v);
    }
    out.put(std::bit_cast<std::uint64_t>(core.time));
    for (std::size_t b = 0; b < core.grid.brick_count(); ++b) {
        sparse_grid::brick const* const stored = core.grid.stored(b);
        out.put(stored != nullptr ? 2 : core.grid.is_rock_brick(b) ? 1 : 0, 1);
        if (stored == nullptr) continue;
        for (std::uint32_t const w : stored->solid) out.put(w, 4);
        for (std::uint32_t const w : stored->colluvium) out.put(w, 4);
    }
    out.put(skin_hash(core.skins));
    for (std::size_t const s : slots_by_brick(core.skins)) {
        voxel_skin const& skin = core.skins[s];
        for (double const d : skin.left[skin.now]) out.put(std::bit_cast<std::uint64_t>(d));
    }
    for (std::size_t const s : slots_by_brick(core.skins)) {
        voxel_skin const& skin = core.skins[s];
        if (skin.covered.empty()) continue;
        out.put(core.skins.brick(s));
        out.put(skin.covered.size());
        for (brick_position const p : skin.covered) out.put(p, 2);
        for (double const d : skin.covered_left) out.put(std::bit_cast<std::uint64_t>(d));
    }
    out.put(~std::uint64_t{0});
    out.put(core.blocks.size());
    for (fallen_block const& b : core.blocks) {
        out.put(b.step);
        out.put(b.voxels.size());
        for (voxel const v : b.voxels) {
            for (std::int32_t const x : {v.x, v.y, v.z}) out.put(static_cast<std::uint32_t>(x), 4);
        }
    }
    out.put(byte_hash(out.bytes()));
    return std::move(out.bytes());
}

/// Reads all, checks all, and only then changes `core`.
template <class Process>
void read_checkpoint(voxel_core<Process>& core, std::span<std::byte const> bytes) {
    auto const bad = [](char const* why) {
        fail<io_error>(errc::bad_syntax, std::string("voxel_run::resume: ") + why);
    };
    byte_reader in(bytes, "voxel_run::resume");
    if (bytes.size() < 8 || in.get() != voxel_checkpoint_magic) {
        fail<io_error>(errc::wrong_format, "voxel_run::resume: these bytes are no voxel checkpoint");
    }
    if (std::uint64_t const version = in.get(4); version != voxel_checkpoint_version) {
        fail<io_error>(errc::unsupported, "voxel_run::resume: checkpoint version " + std::to_string(version) +
                                              ", this library reads " + std::to_string(voxel_checkpoint_version));
    }
    if (in.get() != core.first_grid) {
        fail<io_error>(errc::checkpoint_mismatch, "voxel_run::resume: the checkpoint belongs to another grid");
    }
    if (in.get() != parameter_hash(core)) {
        fail<io_error>(errc::checkpoint_mismatch, "voxel_run::resume: the checkpoint was made with other parameters");
    }
    if (bytes.size() < 16 || [&] {
            byte_reader end(bytes.last(8), "voxel_run::resume");
            return end.get() != byte_hash(bytes.first(bytes.size() - 8));
        }()) {
        bad("the checksum is wrong");
    }
    auto const number = [&in, &bad] {
        double const d = std::bit_cast<double>(in.get());
        if (!(d > -1e300 && d <= 100)) bad("a decimation is out of range");
        return d;
    };
    voxel_report c = core.count;
    for (std::uint64_t* v : {&c.steps, &c.voxels_rock, &c.voxels_colluvium, &c.voxels_vanished, &c.voxels_fallen, &c.voxels_left}) {
        *v = in.get();
    }
    double const time = std::bit_cast<double>(in.get());
    if (!(time >= 0 && time < 1)) bad("the time is out of range");
    sparse_grid grid = core.grid;
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        std::uint64_t const kind = in.get(1);
        if (kind > 2) bad("a brick is of no kind");
        sparse_grid::brick& brick = grid.make_mixed(b);
        for (std::size_t w = 0; w < 1024; ++w) {
            std::uint32_t const inside = grid.inside_word(b, w);
            brick.solid[w] = kind == 2 ? static_cast<std::uint32_t>(in.get(4)) : kind == 1 ? inside : 0;
            if ((brick.solid[w] & ~inside) != 0) bad("a voxel lies outside the grid");
        }
        for (std::size_t w = 0; w < 1024; ++w) {
            brick.colluvium[w] = kind == 2 ? static_cast<std::uint32_t>(in.get(4)) : 0;
            if ((brick.colluvium[w] & ~brick.solid[w]) != 0) bad("a voxel is colluvium but not solid");
        }
        if (kind != 2) grid.compact(b);
    }
    if (c.voxels_rock != grid.count(voxel_plane::rock) || c.voxels_colluvium != grid.count(voxel_plane::colluvium) ||
        c.voxels_rock + c.voxels_colluvium + c.voxels_vanished + c.voxels_fallen + c.voxels_left != c.voxels_initial) {
        bad("the voxels do not add up");
    }
    voxel_skins skins = core.skin_of(grid);
    if (in.get() != skin_hash(skins)) {
        fail<io_error>(errc::checkpoint_mismatch,
                       "voxel_run::resume: the checkpoint was made with another durability or choice of bubbles");
    }
    for (std::size_t const s : slots_by_brick(skins)) {
        for (double& d : skins[s].left[skins[s].now]) d = number();
    }
    for (std::uint64_t brick = in.get(); brick != ~std::uint64_t{0}; brick = in.get()) {
        if (brick >= grid.brick_count()) bad("a brick does not exist");
        voxel_skin& skin = skins.of_brick(brick);
        std::uint64_t const n = in.get();
        if (n > 32768 || n == 0 || !skin.covered.empty()) bad("a brick covers too many voxels");
        for (std::uint64_t k = 0; k < n; ++k) {
            auto const p = static_cast<brick_position>(in.get(2));
            bool const ascends = skin.covered.empty() || skin.covered.back() < p;
            if (!ascends || p > 32767 || skin.find(p) != skin.size()) bad("a covered voxel is out of order");
            skin.covered.push_back(p);
        }
        for (std::uint64_t k = 0; k < n; ++k) skin.covered_left.push_back(number());
    }
    std::vector<fallen_block> blocks;
    std::uint64_t const count = in.get();
    std::uint64_t fallen = 0;
    for (std::uint64_t k = 0; k < count; ++k) {
        fallen_block b{.step = in.get()};
        std::uint64_t const n = in.get();
        if (n == 0 || n > in.left() / 12) bad("a block has more voxels than there are bytes");
        for (std::uint64_t j = 0; j < n; ++j) {
            std::array<std::int32_t, 3> at{};
            for (std::int32_t& x : at) x = static_cast<std::int32_t>(in.get(4));
            b.voxels.push_back({at[0], at[1], at[2]});
            if (!grid.contains(b.voxels.back())) bad("a block has voxels outside the grid");
        }
        fallen += n;
        blocks.push_back(std::move(b));
    }
    if (fallen != c.voxels_fallen) bad("the blocks do not add up");
    if (in.left() != 8) bad("bytes follow the end");
    c.blocks = count;
    c.surface_voxels = skins.voxel_count();
    core.resume(std::move(grid), std::move(skins), std::move(blocks), c, time);
}

}  // namespace tafoni::detail

#endif
