/// \file
/// Marching cubes over samples, layer by layer: two planes of nodes are held, whatever the height.
#ifndef TAFONI_VOXEL_DETAIL_ISOSURFACE_SLABS_HPP
#define TAFONI_VOXEL_DETAIL_ISOSURFACE_SLABS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/detail/node_bits.hpp>
#include <tafoni/voxel/detail/surface_cases.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Where samples lie, and how many empty nodes stand around them.
struct node_lattice {
    std::array<std::size_t, 3> size{};
    vec3 origin{0, 0, 0};  ///< of node (0, 0, 0)
    vec3 spacing{1, 1, 1};
    std::size_t pad = 1;  ///< 1: closed by nodes beyond every side that are never inside; 0: open
    char const* who = "isosurface";  ///< in messages

    [[nodiscard]] std::size_t nodes(std::size_t axis) const noexcept { return size[axis] + 2 * pad; }
    [[nodiscard]] std::size_t layers() const noexcept { return nodes(2) - 1; }
};

/// The part of a surface that the layers begin .. end - 1 of cells give; vertices on the plane of nodes at `end` are
/// counted on, and are the next part's first.
struct surface_slab {
    std::vector<vec3> positions{};
    std::vector<std::uint32_t> corners{};

    /// A vertex on the edge along `axis` from a node, padding counted.
    void add_vertex(vec3 const& p, std::size_t /*axis*/, std::array<std::size_t, 3> const& /*node*/) { positions.push_back(p); }
    /// A cell with a boundary; the number of its edge e is edge[e][node[0]].
    void add_cell(unsigned solid, std::array<std::uint32_t const*, 12> const& edge, std::array<std::size_t, 3> const& node) {
        surface_case const& c = surface_cases[solid];
        for (std::size_t t = 0; t < c.count; ++t) {
            for (std::size_t k = 0; k < 3; ++k) corners.push_back(edge[c.triangles[t][k]][node[0]]);
        }
    }
};

/// `plane(k, buffer)` gives the samples of plane k, x fastest, in the buffer or elsewhere. `Sink` has the functions and
/// the `corners` of `surface_slab`.
template <class Sample, class Plane, class Sink = surface_slab>
class slab_walk {
public:
    slab_walk(node_lattice const& lattice, double iso, Plane const& plane)
        : at_(lattice), iso_(iso), plane_(plane), nx_(lattice.nodes(0)), ny_(lattice.nodes(1)), words_((nx_ + 63) / 64 + 1) {
        for (node_plane* p : {&low_, &high_}) {
            p->bits.assign(words_ * ny_, 0);
            p->along_x.assign(nx_ * ny_, 0);
            p->along_y.assign(nx_ * ny_, 0);
        }
        along_z_.assign(nx_ * ny_, 0);
    }

    Sink walk(std::size_t begin, std::size_t end) {
        load(low_, begin);
        number_plane(low_, true);
        for (std::size_t p = begin; p < end; ++p) {
            load(high_, p + 1);
            number_columns();
            number_plane(high_, p + 1 < end || p + 1 == at_.layers());
            for (std::size_t j = 0; j + 1 < ny_; ++j) emit_row(j);
            std::swap(low_, high_);
        }
        return std::move(out_);
    }

private:
    struct node_plane {
        std::size_t index = 0;
        Sample const* samples = nullptr;  ///< null for a plane of padding
        std::vector<Sample> buffer{};
        std::vector<std::uint64_t> bits{};  ///< rows of `words_`, the last of which stays 0
        std::vector<std::uint32_t> along_x{};
        std::vector<std::uint32_t> along_y{};
    };

    void load(node_plane& p, std::size_t index) {
        p.index = index;
        p.samples = nullptr;
        if (index < at_.pad || index >= at_.size[2] + at_.pad) {
            p.bits.assign(p.bits.size(), 0);
            return;
        }
        std::size_t const k = index - at_.pad;
        p.samples = plane_(k, p.buffer);
        bool finite = true;
        for (std::size_t j = 0; j < at_.size[1]; ++j) {
            Sample const* const row = p.samples + at_.size[0] * j;
            std::uint64_t* const bits = p.bits.data() + words_ * (j + at_.pad);
            std::size_t i = 0;
            for (std::size_t w = 0; w + 1 < words_; ++w) {
                std::size_t const skip = w == 0 ? at_.pad : 0;
                std::size_t const n = at_.size[0] - i < 64 - skip ? at_.size[0] - i : 64 - skip;
                bits[w] = node_bits(row + i, n, iso_, finite) << skip;
                i += n;
            }
        }
        if (!finite) name_bad_sample(p.samples, k);
    }

    [[noreturn]] void name_bad_sample(Sample const* samples, std::size_t k) const {
        std::size_t n = 0;
        while (std::isfinite(static_cast<double>(samples[n]))) ++n;
        std::size_t const index = n + at_.size[0] * at_.size[1] * k;
        fail<invalid_input>(errc::bad_parameter,
                            std::string(at_.who) + ": sample " + std::to_string(index) + " at (" + std::to_string(n % at_.size[0]) + ", " +
                                std::to_string(n / at_.size[0]) + ", " + std::to_string(k) + ") is not finite",
                            {.kind = entity::voxel, .index = index, .value = static_cast<double>(samples[n])});
    }

    [[nodiscard]] bool padding(std::size_t i, std::size_t axis) const noexcept {
        return i < at_.pad || i >= at_.size[axis] + at_.pad;
    }
    [[nodiscard]] double sample(node_plane const& p, std::size_t i, std::size_t j) const noexcept {
        return static_cast<double>(p.samples[i - at_.pad + at_.size[0] * (j - at_.pad)]);
    }
    [[nodiscard]] double coordinate(std::size_t axis, std::size_t i, double t) const noexcept {
        auto const a = static_cast<Eigen::Index>(axis);
        return at_.origin[a] + at_.spacing[a] * (static_cast<double>(i) + (t - static_cast<double>(at_.pad)));
    }
    /// Where between a and b, one of them inside, the level lies.
    [[nodiscard]] double share(double a, double b) const noexcept {
        double width = b - a;
        double rise = iso_ - a;
        if (!(std::fabs(width) <= 1.7976931348623157e308)) {
            width = 0.5 * b - 0.5 * a;
            rise = 0.5 * iso_ - 0.5 * a;
        }
        double const t = rise / width;
        return t >= 0 ? (t <= 1 ? t : 1.0) : 0.0;
    }

    template <class F>
    void for_bits(std::uint64_t bits, std::size_t w, F const& f) const {
        for (; bits != 0; bits &= bits - 1) f(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
    }

    /// Edges along x and y within a plane, row by row; `emit` where they belong to this part.
    void number_plane(node_plane& p, bool emit) {
        for (std::size_t j = 0; j < ny_; ++j) {
            std::uint64_t const* const row = p.bits.data() + words_ * j;
            for (std::size_t w = 0; w + 1 < words_; ++w) {
                std::uint64_t differ = row[w] ^ (row[w] >> 1 | row[w + 1] << 63);
                if (nx_ - 1 < 64 * (w + 1)) differ &= (std::uint64_t{1} << ((nx_ - 1) & 63)) - 1;
                for_bits(differ, w, [&](std::size_t i) {
                    p.along_x[i + nx_ * j] = count_++;
                    if (!emit) return;
                    double const t = padding(i, 0) ? 1.0 : padding(i + 1, 0) ? 0.0 : share(sample(p, i, j), sample(p, i + 1, j));
                    out_.add_vertex(vec3{coordinate(0, i, t), coordinate(1, j, 0), coordinate(2, p.index, 0)}, 0, {i, j, p.index});
                });
            }
            if (j + 1 == ny_) break;
            for (std::size_t w = 0; w + 1 < words_; ++w) {
                for_bits(row[w] ^ row[w + words_], w, [&](std::size_t i) {
                    p.along_y[i + nx_ * j] = count_++;
                    if (!emit) return;
                    double const t = padding(j, 1) ? 1.0 : padding(j + 1, 1) ? 0.0 : share(sample(p, i, j), sample(p, i, j + 1));
                    out_.add_vertex(vec3{coordinate(0, i, 0), coordinate(1, j, t), coordinate(2, p.index, 0)}, 1, {i, j, p.index});
                });
            }
        }
        require_countable();
    }

    void number_columns() {
        for (std::size_t j = 0; j < ny_; ++j) {
            for (std::size_t w = 0; w + 1 < words_; ++w) {
                for_bits(low_.bits[w + words_ * j] ^ high_.bits[w + words_ * j], w, [&](std::size_t i) {
                    along_z_[i + nx_ * j] = count_++;
                    double const t = low_.samples == nullptr    ? 1.0
                                     : high_.samples == nullptr ? 0.0
                                                                : share(sample(low_, i, j), sample(high_, i, j));
                    out_.add_vertex(vec3{coordinate(0, i, 0), coordinate(1, j, 0), coordinate(2, low_.index, t)}, 2, {i, j, low_.index});
                });
            }
        }
        require_countable();
    }

    /// A layer adds fewer than 2^31 vertices where a plane has fewer than 2^29 nodes; asked once per step.
    void require_countable() const {
        if (count_ > 0x80000000U || out_.corners.size() > 0xC0000000U) {
            fail<invalid_input>(errc::size_overflow, std::string(at_.who) + ": more than 2^31 vertices");
        }
    }

    void emit_row(std::size_t j) {
        std::array<std::uint64_t const*, 4> const row{low_.bits.data() + words_ * j, low_.bits.data() + words_ * (j + 1),
                                                      high_.bits.data() + words_ * j, high_.bits.data() + words_ * (j + 1)};
        // Numbers of a cell's twelve edges lie at fixed steps from the cell's node.
        std::size_t const here = nx_ * j;
        std::array<std::uint32_t const*, 12> const edge{
            low_.along_x.data() + here,         low_.along_x.data() + here + nx_, high_.along_x.data() + here,
            high_.along_x.data() + here + nx_,  low_.along_y.data() + here,       high_.along_y.data() + here,
            low_.along_y.data() + here + 1,     high_.along_y.data() + here + 1,  along_z_.data() + here,
            along_z_.data() + here + 1,         along_z_.data() + here + nx_,     along_z_.data() + here + nx_ + 1};
        for (std::size_t w = 0; w + 1 < words_; ++w) {
            std::uint64_t const some = row[0][w] | row[1][w] | row[2][w] | row[3][w];
            std::uint64_t const all = row[0][w] & row[1][w] & row[2][w] & row[3][w];
            std::uint64_t const next_some = row[0][w + 1] | row[1][w + 1] | row[2][w + 1] | row[3][w + 1];
            std::uint64_t const next_all = row[0][w + 1] & row[1][w + 1] & row[2][w + 1] & row[3][w + 1];
            std::uint64_t left = (some | some >> 1 | next_some << 63) & ~(all & (all >> 1 | next_all << 63));
            if (nx_ - 1 < 64 * (w + 1)) left &= (std::uint64_t{1} << ((nx_ - 1) & 63)) - 1;
            if (left == 0) continue;
            std::array<std::uint64_t, 4> right{};
            for (std::size_t r = 0; r < 4; ++r) right[r] = row[r][w] >> 1 | row[r][w + 1] << 63;
            for (; left != 0; left &= left - 1) {
                int const b = std::countr_zero(left);
                unsigned solid = 0;
                for (std::size_t r = 0; r < 4; ++r) {
                    solid |= static_cast<unsigned>((row[r][w] >> b & 1U) | (right[r] >> b & 1U) << 1) << (2 * r);
                }
                out_.add_cell(solid, edge, {64 * w + static_cast<std::size_t>(b), j, low_.index});
            }
        }
    }

    node_lattice at_;
    double iso_;
    Plane const& plane_;
    std::size_t nx_;
    std::size_t ny_;
    std::size_t words_;
    node_plane low_{};
    node_plane high_{};
    std::vector<std::uint32_t> along_z_{};
    std::uint32_t count_ = 0;
    Sink out_{};
};

}  // namespace tafoni::detail

#endif
