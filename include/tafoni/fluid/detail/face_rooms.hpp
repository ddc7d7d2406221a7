/// \file
/// The cells of a grid that faces are near, and what tells a particle at once that it touches none of them.
#ifndef TAFONI_FLUID_DETAIL_FACE_ROOMS_HPP
#define TAFONI_FLUID_DETAIL_FACE_ROOMS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/detail/face_balls.hpp>
#include <tafoni/fluid/detail/face_discs.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Faces in the cells of a regular grid that they come within reach of while no corner moves farther than the slack.
///
/// A cell with faces is a room. Besides its faces it knows which of its 4 x 4 x 4 parts they are near, and two parallel
/// planes that they lie between. All lengths in float are in cells, from the corner of the grid; what rounding does to them
/// is less than the blur.
class face_rooms {
public:
    using triangle = std::array<std::uint32_t, 3>;

    /// A point, and the quarters of cells that it is in.
    struct place {
        float x = 0;
        float y = 0;
        float z = 0;
        std::uint32_t i = 0;
        std::uint32_t j = 0;
        std::uint32_t k = 0;
        bool inside = false;
    };
    struct alignas(32) room {
        std::uint64_t near_to = 0;  ///< parts that a face may be within reach of
        float nx = 0;
        float ny = 0;
        float nz = 0;
        float middle = 0;  ///< of the slab along its normal
        float half = 0;    ///< of its thickness
        std::uint32_t begin = 0;  ///< in packs; where the next room's begin, its own end
    };

    [[nodiscard]] double slack() const noexcept { return slack_; }
    [[nodiscard]] double inverse() const noexcept { return inverse_; }
    [[nodiscard]] float blur() const noexcept { return blur_; }
    [[nodiscard]] std::size_t count() const noexcept { return least_.size(); }
    [[nodiscard]] room const& operator[](std::uint32_t r) const noexcept { return rooms_[r]; }
    [[nodiscard]] std::uint32_t end_of(std::uint32_t r) const noexcept { return rooms_[std::size_t{r} + 1].begin; }
    [[nodiscard]] ball_pack const& balls(std::uint32_t pack) const noexcept { return balls_[pack]; }
    [[nodiscard]] std::uint32_t const* faces(std::uint32_t pack) const noexcept { return faces_.data() + ball_pack::count * std::size_t{pack}; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return (room_of_.capacity() + faces_.capacity()) * sizeof(std::uint32_t) + rooms_.capacity() * sizeof(room) +
               balls_.capacity() * sizeof(ball_pack) + entries_.capacity() * sizeof(entry) + least_.capacity() * sizeof(float);
    }

    /// Asks memory for the first packs of a room.
    void fetch(std::uint32_t r) const noexcept {
#if defined(__GNUC__)
        std::size_t const begin = rooms_[r].begin;
        std::size_t const end = std::min<std::size_t>(rooms_[std::size_t{r} + 1].begin, begin + 4);
        for (std::size_t b = begin; b < end; ++b) {
            __builtin_prefetch(balls_.data() + b);
            __builtin_prefetch(faces_.data() + ball_pack::count * b);
        }
#endif
    }

    /// How far a corner may be from where the cells were filled for.
    void drift(double far) noexcept {
        drift_ = static_cast<float>(far * inverse_) * (1 + 1e-5F);
        meets_ = static_cast<float>(reach_ * inverse_) * (1 + 1e-5F) + drift_ + blur_;
    }
    /// A ball's distance from what it is met by, for contacts over a face: (point - middle)^2 is at most radius^2 + reach^2.
    [[nodiscard]] float over(std::uint32_t r, float reach) const noexcept { return std::min(least_[r] + 3 * drift_, reach + drift_); }
    /// The same for all contacts.
    [[nodiscard]] float any(float reach) const noexcept { return reach + drift_; }

    [[nodiscard]] place see(vec3 const& p) const noexcept {
        place out;
        double const x = (p[0] - lo_[0]) * inverse_;
        double const y = (p[1] - lo_[1]) * inverse_;
        double const z = (p[2] - lo_[2]) * inverse_;
        out.x = static_cast<float>(x);
        out.y = static_cast<float>(y);
        out.z = static_cast<float>(z);
        out.inside = x >= 0 && y >= 0 && z >= 0 && x < top_[0] && y < top_[1] && z < top_[2];
        if (!out.inside) return out;
        out.i = static_cast<std::uint32_t>(static_cast<std::int32_t>(4 * x));
        out.j = static_cast<std::uint32_t>(static_cast<std::int32_t>(4 * y));
        out.k = static_cast<std::uint32_t>(static_cast<std::int32_t>(4 * z));
        return out;
    }
    /// The room that a place is in, or 0 where no face can be within reach.
    [[nodiscard]] std::uint32_t room_at(place const& at) const noexcept {
        if (!at.inside) return 0;
        std::uint32_t const number = room_of_[(at.i >> 2) + size_[0] * ((at.j >> 2) + size_[1] * std::size_t{at.k >> 2})];
        room const& r = rooms_[number];
        auto const here = static_cast<std::uint32_t>(r.near_to >> ((at.i & 3) + 4 * (at.j & 3) + 16 * (at.k & 3)) & 1U);
        float const over = at.x * r.nx + at.y * r.ny + at.z * r.nz - r.middle;
        return number * (here & static_cast<std::uint32_t>(!(std::fabs(over) > r.half + meets_)));
    }

    /// Cells that are about as long as the larger of four times the reach and the mean edge. O(faces).
    void lay_out(std::span<vec3 const> positions, std::span<triangle const> triangles, double reach) {
        box3 box;
        double edges = 0;
        for (auto const& t : triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                box.include(positions[t[k]]);
                edges += length(positions[t[k]] - positions[t[(k + 1) % 3]]);
            }
        }
        reach_ = reach;
        size_ = {0, 0, 0};
        top_ = {0, 0, 0};
        if (triangles.empty()) return;
        double const edge = edges / (3 * static_cast<double>(triangles.size()));
        double cell = std::max(4 * reach_, edge);
        slack_ = 0.25 * std::max(reach_, edge);
        double const rim = reach_ + slack_;
        vec3 const e = box.extent();
        lo_ = vec3{box.lo[0] - rim, box.lo[1] - rim, box.lo[2] - rim};
        auto const along = [&](int d) { return std::floor((e[d] + 2 * rim) / cell) + 1; };
        while (along(0) * along(1) * along(2) > most_cells || std::max({along(0), along(1), along(2)}) > most_along) cell *= 1.25;
        inverse_ = 1 / cell;
        for (int d = 0; d < 3; ++d) {
            top_[static_cast<std::size_t>(d)] = along(d);
            size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
        }
        blur_ = static_cast<float>(1e-6 * (std::max({e[0], e[1], e[2]}) + 2 * rim) * inverse_);
    }

    /// After `lay_out`, for discs seen from there. O(faces + cells in the boxes of the faces).
    void fill(std::span<vec3 const> positions, std::span<triangle const> triangles, std::span<face_disc const> discs) {
        room_of_.assign(size_[0] * size_[1] * size_[2], 0);
        rooms_.assign(1, {});
        least_.assign(1, 0);
        entries_.clear();
        for (std::uint32_t f = 0; f < triangles.size(); ++f) {
            face_disc const& d = discs[f];
            for_each_cell(d, span_of(positions, triangles[f]), [&](std::size_t c, std::uint64_t parts, float x, float y, float z) {
                if (room_of_[c] == 0) {
                    room_of_[c] = static_cast<std::uint32_t>(rooms_.size());
                    rooms_.emplace_back();
                    least_.push_back(std::numeric_limits<float>::max());
                }
                room& r = rooms_[room_of_[c]];
                ++r.begin;
                r.near_to |= parts;
                float const side = r.nx * d.nx + r.ny * d.ny + r.nz * d.nz < 0 ? -d.square : d.square;
                r.nx += side * d.nx;
                r.ny += side * d.ny;
                r.nz += side * d.nz;
                least_[room_of_[c]] = std::min(least_[room_of_[c]], d.radius);
                entries_.push_back({room_of_[c], f, face_ball::around(x, y, z, d.radius + 2 * blur_)});
            });
        }
        constexpr std::uint32_t pack = ball_pack::count;
        require_indexable("mesh_boundary: faces in cells", entries_.size() + pack * rooms_.size());
        std::uint32_t total = 0;
        at_.resize(rooms_.size());
        float const reach = static_cast<float>(reach_ * inverse_) * (1 + 1e-5F) + blur_;
        for (std::size_t k = 0; k < rooms_.size(); ++k) {
            room& r = rooms_[k];
            std::uint32_t const faces = r.begin;
            r.begin = total;
            at_[k] = total * pack;
            total += (faces + pack - 1) / pack;
            float const l = std::sqrt(r.nx * r.nx + r.ny * r.ny + r.nz * r.nz);
            float const s = l > 0 && l < std::numeric_limits<float>::max() ? 1 / l : 0.0F;
            r.nx *= s;
            r.ny *= s;
            r.nz *= s;
            r.middle = std::numeric_limits<float>::max();
            r.half = std::numeric_limits<float>::lowest();
            least_[k] = std::min(reach, (std::sqrt(least_[k] * least_[k] + reach * reach) - least_[k]) + 1e-6F * least_[k]) + 2 * blur_;
        }
        rooms_.push_back({.begin = total});
        faces_.assign(std::size_t{total} * pack, 0);
        balls_.assign(total, {});
        for (entry const& e : entries_) {
            std::uint32_t const to = at_[e.room]++;
            faces_[to] = e.face;
            balls_[to / pack].put(to % pack, e.ball);
            room& r = rooms_[e.room];
            face_disc const& d = discs[e.face];
            float const along = r.nx * d.nx + r.ny * d.ny + r.nz * d.nz;
            float const thick = d.radius * (std::sqrt(std::max(1 - along * along, 0.0F)) + 1e-3F);
            float const at = r.nx * d.x + r.ny * d.y + r.nz * d.z;
            r.middle = std::min(r.middle, at - thick);
            r.half = std::max(r.half, at + thick);
        }
        for (room& r : rooms_) {
            float const low = r.middle;
            float const high = r.half;
            r.middle = 0.5F * (low + high);
            r.half = 0.5F * (high - low) + 2 * blur_;
        }
        drift(0);
    }

private:
    static constexpr double most_cells = 8e6;
    static constexpr double most_along = 65536;  ///< so that float tells places in one apart

    struct entry {
        std::uint32_t room = 0;
        std::uint32_t face = 0;
        face_ball ball{};
    };
    /// Quarters of cells around a face.
    struct cell_span {
        std::array<std::uint32_t, 3> low{};
        std::array<std::uint32_t, 3> high{};

        /// Which of the quarters of the cell number c are among them along an axis, as bits.
        [[nodiscard]] std::uint32_t bits(std::size_t axis, std::uint32_t c) const noexcept {
            std::uint32_t const from = low[axis] > 4 * c ? low[axis] - 4 * c : 0;
            std::uint32_t const to = std::min(high[axis] - 4 * c, 3U);
            return (2U << to) - (1U << from);
        }
    };
    /// In quarters of a cell, in the grid.
    [[nodiscard]] std::uint32_t quarter(int d, double x) const noexcept {
        return static_cast<std::uint32_t>(std::clamp(4 * ((x - lo_[d]) * inverse_), 0.0, 4 * top_[static_cast<std::size_t>(d)] - 1));
    }
    [[nodiscard]] cell_span span_of(std::span<vec3 const> positions, triangle const& t) const noexcept {
        cell_span s;
        vec3 const& a = positions[t[0]];
        vec3 const& b = positions[t[1]];
        vec3 const& c = positions[t[2]];
        double const rim = reach_ + slack_;
        for (int d = 0; d < 3; ++d) {
            s.low[static_cast<std::size_t>(d)] = quarter(d, std::min({a[d], b[d], c[d]}) - rim);
            s.high[static_cast<std::size_t>(d)] = quarter(d, std::max({a[d], b[d], c[d]}) + rim);
        }
        return s;
    }
    /// Those of the cells around a face that its plane comes near: what is within reach of a face whose corners have
    /// moved by the slack is within the sum of both of the face as it was.
    template <class F>
    void for_each_cell(face_disc const& d, cell_span const& s, F const& visit) const {
        // Bits of y and z moved to where a number of a part has them.
        constexpr std::array<std::uint64_t, 16> spread{0x0000, 0x0001, 0x0010, 0x0011, 0x0100, 0x0101, 0x0110, 0x0111,
                                                       0x1000, 0x1001, 0x1010, 0x1011, 0x1100, 0x1101, 0x1110, 0x1111};
        float const rim = static_cast<float>((reach_ + slack_) * inverse_) + 2 * blur_ +
                          0.5001F * (std::fabs(d.nx) + std::fabs(d.ny) + std::fabs(d.nz));
        for (std::uint32_t z = s.low[2] >> 2; z <= s.high[2] >> 2; ++z) {
            float const over_z = (static_cast<float>(z) + 0.5F - d.z) * d.nz - d.x * d.nx;
            std::uint32_t const z_bits = s.bits(2, z);
            std::uint64_t const planes = std::uint64_t{z_bits & 1U} | std::uint64_t{z_bits >> 1 & 1U} << 16 |
                                         std::uint64_t{z_bits >> 2 & 1U} << 32 | std::uint64_t{z_bits >> 3 & 1U} << 48;
            for (std::uint32_t y = s.low[1] >> 2; y <= s.high[1] >> 2; ++y) {
                std::size_t const row = size_[0] * (y + size_[1] * z);
                float const over_y = over_z + (static_cast<float>(y) + 0.5F - d.y) * d.ny;
                std::uint64_t const lines = planes * spread[s.bits(1, y)];
                for (std::uint32_t x = s.low[0] >> 2; x <= s.high[0] >> 2; ++x) {
                    float const over = over_y + (static_cast<float>(x) + 0.5F) * d.nx;
                    if (!(over <= rim && over >= -rim)) continue;
                    visit(row + x, lines * s.bits(0, x), d.x - (static_cast<float>(x) + 0.5F), d.y - (static_cast<float>(y) + 0.5F),
                          d.z - (static_cast<float>(z) + 0.5F));
                }
            }
        }
    }

    double reach_ = 1;
    double slack_ = 0;
    double inverse_ = 1;
    float blur_ = 0;
    float drift_ = 0;
    float meets_ = 0;  ///< distance from a slab at which a particle may touch
    vec3 lo_{0, 0, 0};
    std::array<double, 3> top_{};
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> room_of_{};  ///< cell -> place in `rooms_`, of which the first is empty
    std::vector<room> rooms_{};             ///< and one behind the last
    std::vector<float> least_{};            ///< by room: what reach adds to the radius of its least ball, for contacts over faces
    std::vector<std::uint32_t> faces_{};    ///< by room, ascending in each
    std::vector<ball_pack> balls_{};        ///< beside `faces_`
    std::vector<entry> entries_{};          ///< by face, while cells are filled
    std::vector<std::uint32_t> at_{};
};

}  // namespace tafoni::detail

#endif
