/// \file
/// Voxels of rock as cells: the second decomposition, whose links are computed and not stored.
#ifndef TAFONI_DECOMPOSITION_VOXEL_CELLS_HPP
#define TAFONI_DECOMPOSITION_VOXEL_CELLS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/detail/ranked_bits.hpp>
#include <tafoni/voxel/concepts.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// The box of voxels that `voxel_cells` looks at, in the user's frame.
struct voxel_cells_options {
    std::array<std::size_t, 3> size{};  ///< voxels along x, y, z; each at least 1, (nx + 1)(ny + 1)(nz + 1) < 1.4e9
    vec3 spacing{1, 1, 1};              ///< edges of a voxel, length unit, > 0
    vec3 origin{0, 0, 0};               ///< lower corner of voxel (0, 0, 0)
    /// Sides of the box -x, +x, -y, +y, -z, +z whose rock is cut off there: no links, no water.
    std::array<bool, 6> artificial{};

    /// \throws invalid_input  `bad_parameter`, or `size_overflow` with the number of link slots.
    void validate() const;
};

/// Four corners of a voxel's face.
class voxel_loop {
public:
    explicit constexpr voxel_loop(std::array<std::uint32_t, 4> corners) noexcept : corners_(corners) {}

    /// Not a pointer: a loop is a value, and a span over one that is gone must not compile.
    class iterator {
    public:
        using value_type = vertex_index;
        using difference_type = std::ptrdiff_t;
        using iterator_category = std::forward_iterator_tag;
        using pointer = void;
        using reference = vertex_index;
        constexpr iterator() = default;
        constexpr iterator(voxel_loop const* loop, std::size_t k) noexcept : loop_(loop), k_(k) {}
        [[nodiscard]] constexpr vertex_index operator*() const noexcept { return (*loop_)[k_]; }
        constexpr iterator& operator++() noexcept { ++k_; return *this; }
        constexpr iterator operator++(int) noexcept { iterator const old = *this; ++k_; return old; }
        [[nodiscard]] friend constexpr bool operator==(iterator const&, iterator const&) = default;

    private:
        voxel_loop const* loop_ = nullptr;
        std::size_t k_ = 0;
    };

    [[nodiscard]] constexpr std::size_t size() const noexcept { return 4; }
    [[nodiscard]] constexpr vertex_index operator[](std::size_t k) const noexcept { return vertex_index{corners_[k]}; }
    [[nodiscard]] constexpr iterator begin() const noexcept { return {this, 0}; }
    [[nodiscard]] constexpr iterator end() const noexcept { return {this, 4}; }

private:
    std::array<std::uint32_t, 4> corners_;
};

/// Rock voxels of a dense grid. Models `cell_complex` and, without storing it, `link_network`.
///
/// Cells are the rock voxels, numbered densely in the order x fastest, then y, then z. There are
/// three link slots per voxel of a padded grid, one for the face on its upper side along each axis:
/// a slot is used where at least one side is rock and the face is not artificial. Neigh as in
/// section 4.2 of the paper: an interior link has 8 neighbours, an exterior link 4, fewer where
/// artificial faces meet. Every voxel face on the skin is an exterior link of its own. Outside the
/// grid is air. About 0.8 bytes per voxel of the grid and 4 per voxel of rock.
class voxel_cells {
public:
    voxel_cells() = default;

    /// Rock where `is_rock(i, j, k)` says true; asked once per voxel, x fastest. O(voxels).
    template <class IsRock>
    static voxel_cells from_indices(voxel_cells_options const& options, IsRock const& is_rock) {
        options.validate();
        voxel_cells v(options);
        std::uint32_t p = v.padded(0, 0, 0);
        for (std::size_t k = 0; k < options.size[2]; ++k) {
            for (std::size_t j = 0; j < options.size[1]; ++j) {
                p = v.padded(0, static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(k));
                for (std::size_t i = 0; i < options.size[0]; ++i, ++p) {
                    if (is_rock(i, j, k)) v.rock_.insert(p);
                }
            }
        }
        v.finish();
        return v;
    }

    /// Rock where `inside(centre of the voxel)` says true.
    template <class Inside>
    static voxel_cells from_predicate(voxel_cells_options const& options, Inside const& inside) {
        return from_indices(options, [&](std::size_t i, std::size_t j, std::size_t k) {
            return static_cast<bool>(inside(centre(options, i, j, k)));
        });
    }

    /// Rock where `rock[i + nx (j + ny k)]` is not 0.
    /// \throws invalid_input  `attribute_length` if the span does not have nx ny nz entries.
    static voxel_cells from_array(voxel_cells_options const& options, std::span<std::uint8_t const> rock) {
        options.validate();
        std::size_t const n = options.size[0] * options.size[1] * options.size[2];
        if (rock.size() != n) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "voxel_cells: got " + std::to_string(rock.size()) + " voxels, the grid has " +
                                            std::to_string(n),
                                        {.kind = entity::voxel, .value = static_cast<double>(rock.size()),
                                         .limit = static_cast<double>(n)});
        }
        return from_indices(options, [&](std::size_t i, std::size_t j, std::size_t k) {
            return rock[i + options.size[0] * (j + options.size[1] * k)] != 0;
        });
    }

    /// Rock where any grid of voxels has rock; colluvium is as open to water as air. `erase_fallen` leads back.
    /// O(voxels). \throws invalid_input  as `voxel_cells_options::validate`.
    template <voxel_grid G>
    static voxel_cells from_grid(G const& grid, std::array<bool, 6> const& artificial = {}) {
        using access = grid_access<G>;
        return from_indices({.size = access::size(grid), .spacing = access::spacing(grid),
                             .origin = access::origin(grid), .artificial = artificial},
                            [&](std::size_t i, std::size_t j, std::size_t k) {
                                return access::state(grid, i, j, k) == voxel_state::rock;
                            });
    }

    [[nodiscard]] static vec3 centre(voxel_cells_options const& o, std::size_t i, std::size_t j, std::size_t k) noexcept {
        return vec3{o.origin[0] + o.spacing[0] * (static_cast<double>(i) + 0.5),
                    o.origin[1] + o.spacing[1] * (static_cast<double>(j) + 0.5),
                    o.origin[2] + o.spacing[2] * (static_cast<double>(k) + 0.5)};
    }

    // The grid.

    [[nodiscard]] voxel_cells_options const& grid() const noexcept { return options_; }
    /// The cell of voxel (i, j, k); not valid where it is air. O(1).
    [[nodiscard]] cell_index cell_at(std::size_t i, std::size_t j, std::size_t k) const noexcept {
        std::uint32_t const p = padded(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                                       static_cast<std::uint32_t>(k));
        return rock_.contains(p) ? cell_of(p) : cell_index{};
    }
    /// The voxel (i, j, k) of a cell. O(1).
    [[nodiscard]] std::array<std::uint32_t, 3> voxel_of(cell_index c) const noexcept {
        auto const q = unpad(voxel_of_[c.value]);
        return {q[0] - 1, q[1] - 1, q[2] - 1};
    }
    /// The cell that holds the point; not valid in air and outside the grid. O(1).
    [[nodiscard]] cell_index locate(vec3 const& point) const noexcept {
        std::array<std::size_t, 3> at{};
        for (std::size_t d = 0; d < 3; ++d) {
            auto const e = static_cast<Eigen::Index>(d);
            double const x = std::floor((point[e] - options_.origin[e]) / options_.spacing[e]);
            if (!(x >= 0 && x < static_cast<double>(options_.size[d]))) return cell_index{};
            at[d] = static_cast<std::size_t>(x);
        }
        return cell_at(at[0], at[1], at[2]);
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return rock_.bytes() + faces_.bytes() + voxel_of_.capacity() * 4; }

    // cell_complex.

    [[nodiscard]] std::size_t cell_count() const noexcept { return voxel_of_.size(); }
    [[nodiscard]] double cell_volume(cell_index) const noexcept {
        return options_.spacing[0] * options_.spacing[1] * options_.spacing[2];
    }
    [[nodiscard]] vec3 cell_centroid(cell_index c) const noexcept {
        auto const v = voxel_of(c);
        return centre(options_, v[0], v[1], v[2]);
    }
    /// All corners of the grid, also those that no rock touches.
    [[nodiscard]] std::size_t vertex_count() const noexcept {
        return std::size_t{row_} * rows_ * (options_.size[2] + 1);
    }
    [[nodiscard]] vec3 position(vertex_index v) const noexcept {
        auto const q = unpad(v.value);
        return vec3{at(0, q[0]), at(1, q[1]), at(2, q[2])};
    }
    [[nodiscard]] std::size_t face_count() const noexcept { return faces_.count(); }
    [[nodiscard]] std::array<cell_index, 2> face_cells(face_index f) const noexcept { return cells_at(slot_of(f)); }
    [[nodiscard]] std::size_t loop_count(face_index) const noexcept { return 1; }
    [[nodiscard]] voxel_loop face_loop(face_index f, std::size_t) const noexcept {
        slot const s = slot_of(f);
        // The face's first corner is the upper corner along the axis of the lower voxel: its padded
        // coordinates less one along the other axes, which in vertex numbers is the voxel's own number
        // less one step along those.
        std::uint32_t const b = stride_[(s.axis + 1) % 3];
        std::uint32_t const c = stride_[(s.axis + 2) % 3];
        std::uint32_t const o = s.voxel - b - c;
        if (rock_.contains(s.voxel)) return voxel_loop({o, o + b, o + b + c, o + c});
        return voxel_loop({o, o + c, o + b + c, o + b});
    }
    /// The direction of the normal, 0 .. 5 for -x, +x, -y, +y, -z, +z, so that every skin face is a link of its own.
    [[nodiscard]] patch_index face_patch(face_index f) const noexcept {
        slot const s = slot_of(f);
        bool const low = rock_.contains(s.voxel);
        if ((low && rock_.contains(s.voxel + stride_[s.axis])) || is_artificial(s)) return patch_index{};
        return patch_index{2 * s.axis + (low ? 1U : 0U)};
    }
    [[nodiscard]] double model_size() const noexcept {
        return length(vec3{at(0, static_cast<std::uint32_t>(options_.size[0])) - options_.origin[0],
                           at(1, static_cast<std::uint32_t>(options_.size[1])) - options_.origin[1],
                           at(2, static_cast<std::uint32_t>(options_.size[2])) - options_.origin[2]});
    }

    // link_network.

    [[nodiscard]] std::size_t link_count() const noexcept { return slots_; }
    [[nodiscard]] bool has_link(link_index l) const noexcept {
        return faces_.contains(l.value) && !is_artificial(slot_of(l));
    }
    [[nodiscard]] std::array<cell_index, 2> link_cells(link_index l) const noexcept { return cells_at(slot_of(l)); }
    [[nodiscard]] double link_area(link_index l) const noexcept {
        std::uint32_t const a = l.value % 3;
        return options_.spacing[(a + 1) % 3] * options_.spacing[(a + 2) % 3];
    }
    [[nodiscard]] vec3 link_centroid(link_index l) const noexcept {
        slot const s = slot_of(l);
        auto const q = unpad(s.voxel);
        vec3 r;
        for (std::uint32_t d = 0; d < 3; ++d) {
            double const x = static_cast<double>(q[d]) - (d == s.axis ? 0.0 : 0.5);
            r[static_cast<Eigen::Index>(d)] = options_.origin[d] + options_.spacing[d] * x;
        }
        return r;
    }
    [[nodiscard]] vec3 link_normal(link_index l) const noexcept {
        slot const s = slot_of(l);
        vec3 n{0, 0, 0};
        n[static_cast<Eigen::Index>(s.axis)] = rock_.contains(s.voxel) ? 1.0 : -1.0;
        return n;
    }
    template <class Visit>
    void for_each_cell_link(cell_index c, Visit&& visit) const {
        std::uint32_t const p = voxel_of_[c.value];
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            offer(p - stride_[axis], axis, visit);
            offer(p, axis, visit);
        }
    }
    template <class Visit>
    void for_each_neighbor(link_index l, Visit&& visit) const {
        slot const s = slot_of(l);
        std::uint32_t const b = (s.axis + 1) % 3;
        std::uint32_t const c = (s.axis + 2) % 3;
        for (std::uint32_t p : {s.voxel, s.voxel + stride_[s.axis]}) {
            if (!rock_.contains(p)) continue;
            offer(p - stride_[b], b, visit);
            offer(p, b, visit);
            offer(p - stride_[c], c, visit);
            offer(p, c, visit);
        }
    }

private:
    /// The face on the upper side of a padded voxel along an axis.
    struct slot {
        std::uint32_t voxel;
        std::uint32_t axis;
    };

    explicit voxel_cells(voxel_cells_options const& options)
        : options_(options),
          row_(static_cast<std::uint32_t>(options.size[0] + 1)),
          rows_(static_cast<std::uint32_t>(options.size[1] + 1)),
          stride_{1, row_, row_ * rows_},
          row_inverse_(~std::uint64_t{0} / row_ + 1),
          rows_inverse_(~std::uint64_t{0} / rows_ + 1) {
        std::size_t const last = padded(row_ - 2, rows_ - 2, static_cast<std::uint32_t>(options.size[2]) - 1);
        slots_ = 3 * (last + 1);
        rock_ = detail::ranked_bits(last + stride_[2] + 1);
        for (auto side : options.artificial) any_artificial_ = any_artificial_ || side;
    }

    void finish() {
        rock_.finish();
        faces_ = detail::ranked_bits(slots_);
        voxel_of_.reserve(rock_.count());
        auto const voxels = static_cast<std::uint32_t>(slots_ / 3);
        for (std::uint32_t p = 0; p < voxels; ++p) {
            bool const here = rock_.contains(p);
            if (here) voxel_of_.push_back(p);
            for (std::uint32_t a = 0; a < 3; ++a) {
                if (here || rock_.contains(p + stride_[a])) faces_.insert(3 * std::size_t{p} + a);
            }
        }
        faces_.finish();
    }

    /// One column, row and layer of air before the first voxel; the air after the last of a row is the next row's.
    [[nodiscard]] std::uint32_t padded(std::uint32_t i, std::uint32_t j, std::uint32_t k) const noexcept {
        return i + 1 + row_ * (j + 1 + rows_ * (k + 1));
    }
    /// n / d by the reciprocal of d; exact for 32 bits [Lemire, Kaser, Kurz 2019, Faster remainder].
    [[nodiscard]] static std::uint32_t divide(std::uint32_t n, std::uint64_t inverse) noexcept {
        __extension__ using wide = unsigned __int128;
        return static_cast<std::uint32_t>(wide{inverse} * n >> 64);
    }
    [[nodiscard]] std::array<std::uint32_t, 3> unpad(std::uint32_t p) const noexcept {
        std::uint32_t const line = divide(p, row_inverse_);
        std::uint32_t const layer = divide(line, rows_inverse_);
        return {p - line * row_, line - layer * rows_, layer};
    }
    [[nodiscard]] double at(std::size_t axis, std::uint32_t line) const noexcept {
        auto const d = static_cast<Eigen::Index>(axis);
        return options_.origin[d] + options_.spacing[d] * static_cast<double>(line);
    }
    [[nodiscard]] cell_index cell_of(std::uint32_t p) const noexcept { return cell_index{rock_.rank(p)}; }
    [[nodiscard]] static slot slot_of(link_index l) noexcept { return {l.value / 3, l.value % 3}; }
    [[nodiscard]] slot slot_of(face_index f) const noexcept {
        return slot_of(link_index{faces_.select(f.value)});
    }
    [[nodiscard]] std::array<cell_index, 2> cells_at(slot s) const noexcept {
        std::uint32_t const above = s.voxel + stride_[s.axis];
        if (!rock_.contains(s.voxel)) return {cell_of(above), cell_index{}};
        return {cell_of(s.voxel), rock_.contains(above) ? cell_of(above) : cell_index{}};
    }
    [[nodiscard]] bool is_artificial(slot s) const noexcept {
        if (!any_artificial_) return false;
        std::uint32_t const line = unpad(s.voxel)[s.axis];
        return (line == 0 && options_.artificial[2 * s.axis]) ||
               (line == options_.size[s.axis] && options_.artificial[2 * s.axis + 1]);
    }
    template <class Visit>
    void offer(std::uint32_t voxel, std::uint32_t axis, Visit& visit) const {
        if (!is_artificial({voxel, axis})) visit(link_index{3 * voxel + axis});
    }

    voxel_cells_options options_{};
    std::uint32_t row_ = 1;
    std::uint32_t rows_ = 1;
    std::array<std::uint32_t, 3> stride_{};
    std::uint64_t row_inverse_ = 0;
    std::uint64_t rows_inverse_ = 0;
    std::size_t slots_ = 0;
    bool any_artificial_ = false;
    detail::ranked_bits rock_{};             ///< padded voxels of rock; the rank is the cell
    detail::ranked_bits faces_{};            ///< slots with rock on a side; the rank is the face
    std::vector<std::uint32_t> voxel_of_{};  ///< cell -> padded voxel
};

inline void voxel_cells_options::validate() const {
    for (std::size_t d = 0; d < 3; ++d) {
        auto const e = static_cast<Eigen::Index>(d);
        if (size[d] == 0) {
            detail::fail<invalid_input>(errc::bad_parameter, "voxel_cells_options.size: got 0 voxels along an axis",
                                        {.kind = entity::parameter, .index = d, .value = 0});
        }
        detail::require_range("voxel_cells_options.spacing", spacing[e], std::numeric_limits<double>::min(), 1e100);
        detail::require_range("voxel_cells_options.origin", origin[e], -1e100, 1e100);
    }
    __extension__ using wide = unsigned __int128;
    wide slots = 3;
    for (std::size_t d = 0; d < 3; ++d) {
        slots *= wide{size[d]} + (d < 2 ? 1U : 2U);
        if (slots >= link_index::none) {
            detail::fail<invalid_input>(errc::size_overflow,
                                        "voxel_cells_options.size: the grid needs more link slots than 32 bits number",
                                        {.kind = entity::parameter, .index = d, .value = static_cast<double>(slots),
                                         .limit = static_cast<double>(link_index::none)});
        }
    }
}

static_assert(cell_complex<voxel_cells>);

}  // namespace tafoni

#endif
