/// \file
/// The grid that the processes work on: bits in bricks, and only bricks that hold a boundary are stored.
#ifndef TAFONI_VOXEL_SPARSE_GRID_HPP
#define TAFONI_VOXEL_SPARSE_GRID_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/brick_rows.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// What to see of a grid as bits.
enum class voxel_plane : std::uint8_t { solid, rock, colluvium };  ///< solid: rock or colluvium

/// Rock, air and colluvium in bricks of 32^3 voxels; a brick of nothing but air or nothing but rock takes
/// four bytes, any other 8 KiB [Jones et al., section 4.4, stores what is near the surface].
///
/// Works in turned axes: +z is up, whatever axis of the user's grid that is, and the bits of a column
/// lie in words along z. `voxel` arguments are in turned axes; `to_user`, `from_user` and `centre` lead
/// back. Different bricks may be changed by different threads once `make_mixed` has stored them.
/// Models `editable_voxel_grid` (in the user's axes).
class sparse_grid {
public:
    static constexpr std::int32_t edge = 32;  ///< voxels along a brick
    static constexpr std::int32_t bottomless = std::numeric_limits<std::int32_t>::max();

    sparse_grid() = default;

    /// All air. O(bricks). \throws invalid_input  as `grid_frame::validate`; `size_overflow` for 2^31 bricks.
    explicit sparse_grid(grid_frame const& user, up_axis up = up_axis::plus_z, grid_border const& border = {})
        : user_((user.validate(), user)), rotation_(up_rotation::of(up)), border_(rotation_.turned_border(border)) {
        size_ = rotation_.turned_size(user.size);
        std::size_t bricks = 1;
        for (std::size_t d = 0; d < 3; ++d) {
            bricks_[d] = static_cast<std::int32_t>((size_[d] + 31) / 32);
            bricks *= static_cast<std::size_t>(bricks_[d]);
        }
        if (bricks >= std::size_t{1} << 31) {
            detail::fail<invalid_input>(errc::size_overflow, "sparse_grid: got " + std::to_string(bricks) +
                                                                 " bricks of 32^3 voxels, at most 2^31 - 1",
                                        {.kind = entity::voxel, .value = static_cast<double>(bricks), .limit = 0x1p31});
        }
        table_.assign(bricks, all_air);
    }

    /// A copy of any grid. O(voxels). \throws invalid_input  also `out_of_range` where the grid answers a state that
    /// is none, `attribute_length` where its `bytes` are not one per voxel.
    template <voxel_grid G>
    static sparse_grid copy_of(G const& grid, up_axis up = up_axis::plus_z, grid_border const& border = {}) {
        using access = grid_access<G>;
        sparse_grid out({.size = access::size(grid), .spacing = access::spacing(grid), .origin = access::origin(grid)},
                        up, border);
        for (std::size_t b = 0; b < out.brick_count(); ++b) {
            brick bits{};
            detail::read_brick(grid, detail::brick_rows(out.rotation_, out.size_, out.brick_corner(b)), bits);
            out.assign_brick(b, bits);
        }
        return out;
    }

    // Place.

    [[nodiscard]] grid_frame const& user_frame() const noexcept { return user_; }
    [[nodiscard]] up_rotation const& rotation() const noexcept { return rotation_; }
    [[nodiscard]] grid_border const& border() const noexcept { return border_; }  ///< in turned axes
    [[nodiscard]] std::array<std::size_t, 3> const& size() const noexcept { return size_; }  ///< in turned axes
    [[nodiscard]] voxel to_user(voxel v) const noexcept { return rotation_.to_user(v, size_); }
    [[nodiscard]] voxel from_user(voxel u) const noexcept { return rotation_.from_user(u, size_); }
    /// Centre of a voxel in the user's space.
    [[nodiscard]] vec3 centre(voxel v) const noexcept { return user_.centre(to_user(v)); }
    /// Edges of a voxel along the turned axes.
    [[nodiscard]] vec3 spacing() const noexcept {
        return vec3{user_.spacing[rotation_.axis[0]], user_.spacing[rotation_.axis[1]],
                    user_.spacing[rotation_.axis[2]]};
    }
    [[nodiscard]] bool contains(voxel v) const noexcept {
        return static_cast<std::size_t>(v.x) < size_[0] && static_cast<std::size_t>(v.y) < size_[1] &&
               static_cast<std::size_t>(v.z) < size_[2];
    }

    // One voxel.

    /// Beyond the border what `border()` says. O(1).
    [[nodiscard]] voxel_state state(voxel v) const noexcept {
        if (!contains(v)) {
            border_kind const beyond = step_inside(v);
            if (beyond != border_kind::extend) return beyond == border_kind::rock ? voxel_state::rock : voxel_state::air;
        }
        std::uint32_t const slot = table_[brick_of(v)];
        if (slot < first_stored) return slot == all_rock ? voxel_state::rock : voxel_state::air;
        brick const& b = *pool_[slot - first_stored];
        std::size_t const c = column_of(v);
        std::uint32_t const bit = std::uint32_t{1} << (v.z & 31);
        if ((b.colluvium[c] & bit) != 0) return voxel_state::colluvium;
        return (b.solid[c] & bit) != 0 ? voxel_state::rock : voxel_state::air;
    }
    [[nodiscard]] bool is_solid(voxel v) const noexcept { return state(v) != voxel_state::air; }
    [[nodiscard]] bool is_rock(voxel v) const noexcept { return state(v) == voxel_state::rock; }
    /// Changes a voxel inside the grid; stores its brick where it must.
    void set(voxel v, voxel_state s) {
        std::size_t const b = brick_of(v);
        std::uint32_t const slot = table_[b];
        if ((slot == all_air && s == voxel_state::air) || (slot == all_rock && s == voxel_state::rock)) return;
        brick& stored = make_mixed(b);
        std::size_t const c = column_of(v);
        std::uint32_t const bit = std::uint32_t{1} << (v.z & 31);
        stored.solid[c] = s == voxel_state::air ? stored.solid[c] & ~bit : stored.solid[c] | bit;
        stored.colluvium[c] = s == voxel_state::colluvium ? stored.colluvium[c] | bit : stored.colluvium[c] & ~bit;
    }

    /// Voxels of air from v downwards, v included, to the first that is solid; `bottomless` when the column
    /// is open to an airy border below. Beyond the sides of the grid as `border()` says. O(height / 32).
    [[nodiscard]] std::int32_t air_depth(voxel v) const noexcept {
        std::int32_t depth = 0;
        if (static_cast<std::size_t>(v.x) >= size_[0] || static_cast<std::size_t>(v.y) >= size_[1] || v.z < 0) {
            voxel at = v;  // beyond a side: voxel by voxel
            while (at.z >= 0 && !is_solid(at)) { --at.z; ++depth; }
            if (at.z >= 0) return depth;
            return is_solid(at) ? depth : bottomless;
        }
        auto const top = static_cast<std::int32_t>(size_[2]) - 1;
        while (v.z > top) {
            if (is_solid(v)) return depth;
            --v.z;
            ++depth;
        }
        while (v.z >= 0) {
            std::int32_t const in_word = v.z & 31;
            std::uint32_t const word = solid_word(brick_of(v), column_of(v)) << (31 - in_word);
            int const run = std::countl_zero(word);
            if (run <= in_word) return depth + run;
            depth += in_word + 1;
            v.z -= in_word + 1;
        }
        return is_solid(v) ? depth : bottomless;
    }

    /// The kind of border that a voxel beyond the grid lies behind; `v` moves to the outermost voxel there.
    border_kind step_inside(voxel& v) const noexcept {
        bool air = false;
        bool rock = false;
        std::array<std::int32_t*, 3> const at{&v.x, &v.y, &v.z};
        for (std::size_t d = 0; d < 3; ++d) {
            auto const last = static_cast<std::int32_t>(size_[d]) - 1;
            if (*at[d] >= 0 && *at[d] <= last) continue;
            border_kind const kind = border_.sides[2 * d + (*at[d] < 0 ? 0U : 1U)];
            rock = rock || kind == border_kind::rock;
            air = air || kind == border_kind::air;
            *at[d] = *at[d] < 0 ? 0 : last;
        }
        return rock ? border_kind::rock : air ? border_kind::air : border_kind::extend;
    }

    // Bricks.

    struct brick {
        std::array<std::uint32_t, 1024> solid{};      ///< column x + 32 y, bit z
        std::array<std::uint32_t, 1024> colluvium{};  ///< a part of solid
    };

    [[nodiscard]] std::size_t brick_count() const noexcept { return table_.size(); }
    [[nodiscard]] std::array<std::int32_t, 3> const& bricks() const noexcept { return bricks_; }
    [[nodiscard]] std::size_t brick_of(voxel v) const noexcept {
        return static_cast<std::size_t>(v.x >> 5) +
               static_cast<std::size_t>(bricks_[0]) *
                   (static_cast<std::size_t>(v.y >> 5) +
                    static_cast<std::size_t>(bricks_[1]) * static_cast<std::size_t>(v.z >> 5));
    }
    [[nodiscard]] static std::size_t column_of(voxel v) noexcept {
        return static_cast<std::size_t>((v.x & 31) + 32 * (v.y & 31));
    }
    /// Lowest voxel of a brick.
    [[nodiscard]] voxel brick_corner(std::size_t b) const noexcept {
        auto const nx = static_cast<std::size_t>(bricks_[0]);
        auto const ny = static_cast<std::size_t>(bricks_[1]);
        return {static_cast<std::int32_t>(b % nx) * edge, static_cast<std::int32_t>(b / nx % ny) * edge,
                static_cast<std::int32_t>(b / (nx * ny)) * edge};
    }
    [[nodiscard]] bool is_air_brick(std::size_t b) const noexcept { return table_[b] == all_air; }
    [[nodiscard]] bool is_rock_brick(std::size_t b) const noexcept { return table_[b] == all_rock; }
    /// Null where the brick is nothing but air or rock.
    [[nodiscard]] brick const* stored(std::size_t b) const noexcept {
        return table_[b] < first_stored ? nullptr : pool_[table_[b] - first_stored].get();
    }
    /// 32 voxels of a column inside the grid as bits; bits beyond the grid are 0.
    [[nodiscard]] std::uint32_t solid_word(std::size_t b, std::size_t column) const noexcept {
        std::uint32_t const slot = table_[b];
        if (slot >= first_stored) return pool_[slot - first_stored]->solid[column];
        return slot == all_rock ? inside_word(b, column) : 0;
    }
    [[nodiscard]] std::uint32_t colluvium_word(std::size_t b, std::size_t column) const noexcept {
        std::uint32_t const slot = table_[b];
        return slot >= first_stored ? pool_[slot - first_stored]->colluvium[column] : 0;
    }
    [[nodiscard]] std::uint32_t plane_word(voxel_plane p, std::size_t b, std::size_t column) const noexcept {
        std::uint32_t const all = solid_word(b, column);
        if (p == voxel_plane::solid) return all;
        std::uint32_t const loose = colluvium_word(b, column);
        return p == voxel_plane::rock ? all & ~loose : loose;
    }
    /// Bits of the voxels of a brick's column that are inside the grid.
    [[nodiscard]] std::uint32_t inside_word(std::size_t b, std::size_t column) const noexcept {
        return inside_word(brick_corner(b), column);
    }
    [[nodiscard]] std::uint32_t inside_word(voxel low, std::size_t column) const noexcept {
        if (static_cast<std::size_t>(low.x) + (column & 31) >= size_[0] ||
            static_cast<std::size_t>(low.y) + (column >> 5) >= size_[1]) {
            return 0;
        }
        std::size_t const height = size_[2] - static_cast<std::size_t>(low.z);
        return height >= 32 ? ~std::uint32_t{0} : (std::uint32_t{1} << height) - 1;
    }
    /// Stores a brick, to be changed word by word. Not by several threads at once. O(1).
    brick& make_mixed(std::size_t b) {
        std::uint32_t const slot = table_[b];
        if (slot >= first_stored) return *pool_[slot - first_stored];
        auto fresh = std::make_unique<brick>();
        if (slot == all_rock) {
            voxel const low = brick_corner(b);
            for (std::size_t c = 0; c < 1024; ++c) fresh->solid[c] = inside_word(low, c);
        }
        std::uint32_t at = 0;
        if (free_.empty()) {
            at = static_cast<std::uint32_t>(pool_.size());
            pool_.push_back(std::move(fresh));
        } else {
            at = free_.back();
            pool_[at] = std::move(fresh);
            free_.pop_back();
        }
        table_[b] = at + first_stored;
        return *pool_[at];
    }
    /// Forgets the bits of a brick that has become nothing but air or rock. O(1).
    void compact(std::size_t b) {
        std::uint32_t const slot = table_[b];
        if (slot < first_stored) return;
        std::uint32_t const as = uniform(brick_corner(b), *pool_[slot - first_stored]);
        if (as == first_stored) return;
        free_.push_back(slot - first_stored);
        pool_[slot - first_stored].reset();
        table_[b] = as;
    }
    /// Replaces a brick by bits of which none lie beyond the grid; stores them where it must. O(1).
    void assign_brick(std::size_t b, brick const& bits) {
        std::uint32_t const as = uniform(brick_corner(b), bits);
        if (as == first_stored) {
            make_mixed(b) = bits;
            return;
        }
        if (std::uint32_t const slot = table_[b]; slot >= first_stored) {
            free_.push_back(slot - first_stored);
            pool_[slot - first_stored].reset();
        }
        table_[b] = as;
    }
    /// Makes a brick nothing but rock or nothing but air. O(1).
    void fill_uniform(std::size_t b, bool rock) {
        std::uint32_t const slot = table_[b];
        if (slot >= first_stored) {
            free_.push_back(slot - first_stored);
            pool_[slot - first_stored].reset();
        }
        table_[b] = rock ? all_rock : all_air;
    }
    /// Sets every voxel of a brick to state(voxel), asked along z first. O(32^3).
    template <class State>
    void fill_brick(std::size_t b, State const& state) {
        voxel const low = brick_corner(b);
        brick fresh{};
        for (std::size_t c = 0; c < 1024; ++c) {
            std::uint32_t left = inside_word(low, c);
            for (; left != 0; left &= left - 1) {
                int const z = std::countr_zero(left);
                auto const s = state(voxel{low.x + static_cast<std::int32_t>(c & 31),
                                           low.y + static_cast<std::int32_t>(c >> 5), low.z + z});
                std::uint32_t const bit = std::uint32_t{1} << z;
                if (s != voxel_state::air) fresh.solid[c] |= bit;
                if (s == voxel_state::colluvium) fresh.colluvium[c] |= bit;
            }
        }
        assign_brick(b, fresh);
    }

    /// Voxels in a plane. O(bricks).
    [[nodiscard]] std::size_t count(voxel_plane p) const noexcept {
        std::size_t n = 0;
        for (std::size_t b = 0; b < table_.size(); ++b) {
            std::uint32_t const slot = table_[b];
            if (slot == all_air || (slot == all_rock && p == voxel_plane::colluvium)) continue;
            voxel const low = brick_corner(b);
            for (std::size_t c = 0; c < 1024; ++c) {
                std::uint32_t const word = slot == all_rock ? inside_word(low, c) : plane_word(p, b, c);
                n += static_cast<std::size_t>(std::popcount(word));
            }
        }
        return n;
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return table_.capacity() * sizeof(std::uint32_t) + pool_.capacity() * sizeof(void*) +
               (pool_.size() - free_.size()) * sizeof(brick);
    }

    /// What is moved from has no voxels.
    sparse_grid(sparse_grid&& other) noexcept : sparse_grid() { swap(other); }
    sparse_grid& operator=(sparse_grid&& other) noexcept {
        sparse_grid taken(std::move(other));
        swap(taken);
        return *this;
    }
    sparse_grid(sparse_grid const& other)
        : user_(other.user_), rotation_(other.rotation_), border_(other.border_), size_(other.size_),
          bricks_(other.bricks_), table_(other.table_), free_(other.free_) {
        pool_.reserve(other.pool_.size());
        for (auto const& b : other.pool_) pool_.push_back(b ? std::make_unique<brick>(*b) : nullptr);
    }
    sparse_grid& operator=(sparse_grid const& other) {
        sparse_grid copy(other);
        return *this = std::move(copy);
    }
    ~sparse_grid() = default;

private:
    static constexpr std::uint32_t all_air = 0;
    static constexpr std::uint32_t all_rock = 1;
    static constexpr std::uint32_t first_stored = 2;

    /// The slot of a brick that needs no bits, else `first_stored`.
    [[nodiscard]] std::uint32_t uniform(voxel low, brick const& bits) const noexcept {
        bool air = true;
        bool rock = true;
        for (std::size_t c = 0; c < 1024 && (air || rock); ++c) {
            air = air && bits.solid[c] == 0;
            rock = rock && bits.solid[c] == inside_word(low, c) && bits.colluvium[c] == 0;
        }
        return air ? all_air : rock ? all_rock : first_stored;
    }
    void swap(sparse_grid& other) noexcept {
        std::swap(user_, other.user_);
        std::swap(rotation_, other.rotation_);
        std::swap(border_, other.border_);
        std::swap(size_, other.size_);
        std::swap(bricks_, other.bricks_);
        table_.swap(other.table_);
        pool_.swap(other.pool_);
        free_.swap(other.free_);
    }

    grid_frame user_{};
    up_rotation rotation_{};
    grid_border border_{};
    std::array<std::size_t, 3> size_{};
    std::array<std::int32_t, 3> bricks_{};
    std::vector<std::uint32_t> table_{};
    std::vector<std::unique_ptr<brick>> pool_{};
    std::vector<std::uint32_t> free_{};
};

template <>
struct grid_access<sparse_grid> {
    static std::array<std::size_t, 3> size(sparse_grid const& g) { return g.user_frame().size; }
    static vec3 spacing(sparse_grid const& g) { return g.user_frame().spacing; }
    static vec3 origin(sparse_grid const& g) { return g.user_frame().origin; }
    static voxel_state state(sparse_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.state(at(g, i, j, k));
    }
    static void set(sparse_grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) {
        g.set(at(g, i, j, k), s);
    }

private:
    static voxel at(sparse_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.from_user({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)});
    }
};

static_assert(editable_voxel_grid<sparse_grid>);

}  // namespace tafoni

#endif
