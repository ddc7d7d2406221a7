/// \file
/// How much of the winding number of a closed surface is due to the caps of its holes.
#ifndef TAFONI_VOXEL_DETAIL_HOLE_LEVELS_HPP
#define TAFONI_VOXEL_DETAIL_HOLE_LEVELS_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/detail/row_crossings.hpp>
#include <tafoni/voxel/voxel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// For every voxel the winding number of the capped surface from which on the generalised winding number of
/// the open one [Jacobson et al. 2013] is 1/2 or more.
///
/// The open surface is the capped one less its caps, so its number is a whole one, known from rows, less the
/// share S of the full sphere that the caps take up. S is smooth off the caps, and its gradient is
/// at most sum(length / distance^2) / 4 pi over the edges of the holes (Biot and Savart's law): where that
/// bound keeps S within one level all over a block, one evaluation decides the block. Others are halved, down to
/// single voxels. No centre of a voxel may lie on a cap, where S jumps: `cap_holes` puts the apexes out of
/// the way. Asked as `fill_bricks` does.
class hole_levels {
public:
    /// A triangle of a cap: the apex of its hole, and an edge of the hole, as indices of `corners`.
    using cap = std::array<std::uint32_t, 3>;

    /// `size`: voxels along the turned axes; `spacing`: as the frame's.
    hole_levels(row_crossings const& rows, std::array<std::size_t, 3> const& size, vec3 const& spacing,
                std::vector<row_crossings::corner> const& corners, std::vector<cap> caps)
        : rows_(rows), size_(size), caps_(std::move(caps)) {
        double const largest = std::max({spacing[0], spacing[1], spacing[2]});
        for (std::size_t d = 0; d < 3; ++d) {
            scale_[d] = spacing[static_cast<Eigen::Index>(rows.axes().axis[d])] / largest;
        }
        places_.reserve(corners.size());
        for (auto const& c : corners) places_.push_back(place_of(c.x, static_cast<double>(c.y), static_cast<double>(c.z)));
        for (cap const& t : caps_) {
            vec3 const& a = places_[t[0]];
            vec3 const& b = places_[t[1]];
            vec3 const& c = places_[t[2]];
            shape s;
            s.normal = cross(b - a, c - a);
            s.double_area = length(s.normal);
            s.centre = vec3((a + b + c) / 3.0);
            s.radius = std::sqrt(std::max({squared_length(a - s.centre), squared_length(b - s.centre), squared_length(c - s.centre)}));
            s.edge = length(c - b);
            shapes_.push_back(s);
        }
        offsets_.resize(places_.size());
        lengths_.resize(places_.size());
        seen_.resize(places_.size(), 0);
        active_[0].resize(caps_.size());
        std::iota(active_[0].begin(), active_[0].end(), 0U);
    }

    [[nodiscard]] bool is_uniform(voxel low) {
        if (caps_.empty()) return true;
        low_ = low;
        if (decided(low, 32, 0)) return true;
        levels_.resize(32768);
        split(low, 32, 1);
        return false;
    }
    [[nodiscard]] int uniform() const noexcept { return level_; }
    [[nodiscard]] int operator()(std::size_t column, std::size_t z) const noexcept { return levels_[32 * column + z]; }

private:
    static constexpr double pi = 0x1.921fb54442d18p+1;
    static constexpr double one = static_cast<double>(row_crossings::one);
    static constexpr double tie = 0x1p-30;  ///< of a winding number: 1/2 less this is 1/2

    struct shape {
        vec3 normal;  ///< not of unit length
        double double_area;
        vec3 centre;
        double radius;
        double edge;  ///< length of the hole's edge
    };

    /// From voxels along the row and 1 / one across to the unit of the largest spacing.
    [[nodiscard]] vec3 place_of(double x, double y, double z) const noexcept {
        return vec3{x * scale_[0], y / one * scale_[1], z / one * scale_[2]};
    }
    /// A voxel of the turned grid as the rows number it.
    [[nodiscard]] std::array<std::int64_t, 3> in_rows(voxel v) const noexcept {
        std::array<std::int64_t, 3> r{v.z, v.x, v.y};
        for (std::size_t d = 0; d < 3; ++d) {
            if (rows_.axes().mirrored[d]) r[d] = rows_.size()[d] - 1 - r[d];
        }
        return r;
    }
    [[nodiscard]] vec3 centre_of(std::array<std::int64_t, 3> const& v) const noexcept {
        return place_of(static_cast<double>(v[0]) + 0.5, static_cast<double>(row_crossings::line(v[1])),
                        static_cast<double>(row_crossings::line(v[2])));
    }
    [[nodiscard]] static int level_of(double share) noexcept { return static_cast<int>(std::ceil(share + (0.5 - tie))); }

    /// `depth`: halvings that led here and one; the caps that count are `active_[depth]`.
    void split(voxel low, std::int32_t edge, std::size_t depth) {
        if (edge == 1) {
            vec3 const p = centre_of(in_rows(low));
            double const here = share(p, active_[depth]);
            int level = level_of(here - blur_[depth]);
            if (level != level_of(here + blur_[depth])) level = level_of(share(p, active_[0]));
            set(low, 1, level);
            return;
        }
        std::int32_t const half = edge / 2;
        for (std::int32_t child = 0; child < 8; ++child) {
            voxel const at{low.x + half * (child & 1), low.y + half * (child >> 1 & 1), low.z + half * (child >> 2)};
            if (static_cast<std::size_t>(at.x) >= size_[0] || static_cast<std::size_t>(at.y) >= size_[1] ||
                static_cast<std::size_t>(at.z) >= size_[2]) {
                continue;
            }
            if (half == 1) {
                split(at, half, depth);
            } else if (decided(at, half, depth)) {
                set(at, half, level_);
            } else {
                split(at, half, depth + 1);
            }
        }
    }
    void set(voxel low, std::int32_t edge, int level) {
        auto const x = static_cast<std::size_t>(low.x - low_.x);
        auto const y = static_cast<std::size_t>(low.y - low_.y);
        auto const z = static_cast<std::size_t>(low.z - low_.z);
        auto const n = static_cast<std::size_t>(edge);
        for (std::size_t v = 0; v < n; ++v) {
            for (std::size_t u = 0; u < n; ++u) std::fill_n(&levels_[32 * (x + u + 32 * (y + v)) + z], n, level);
        }
    }

    /// Whether one level holds for all voxels of a block; `level_` is it then. Else `active_[depth + 1]` holds
    /// those of `active_[depth]` that matter inside, and `blur_[depth + 1]` what all others can add at most: a
    /// cap is seen as no more than its area over the squared distance. O(active caps).
    bool decided(voxel low, std::int32_t edge, std::size_t depth) {
        voxel const high{std::min(low.x + edge, static_cast<std::int32_t>(size_[0])) - 1,
                         std::min(low.y + edge, static_cast<std::int32_t>(size_[1])) - 1,
                         std::min(low.z + edge, static_cast<std::int32_t>(size_[2])) - 1};
        vec3 const a = centre_of(in_rows(low));
        vec3 const b = centre_of(in_rows(high));
        vec3 const centre = vec3(0.5 * (a + b));
        double const radius = 0.5 * length(b - a) + 0x1p-20;
        double const negligible = 0.05 / static_cast<double>(caps_.size());
        std::vector<std::uint32_t>& kept = active_[depth + 1];
        kept.clear();
        double blur = blur_[depth];
        double slope = far_slope_[depth];
        double far_slope = slope;
        bool smooth = true;
        for (std::uint32_t const t : active_[depth]) {
            shape const& s = shapes_[t];
            double const off = length(centre - s.centre) - radius - s.radius;
            if (off > 0 && s.double_area < 8 * pi * negligible * off * off) {
                blur += s.double_area / (8 * pi * off * off);
                far_slope += s.edge / (off * off);
                slope += s.edge / (off * off);
                continue;
            }
            kept.push_back(t);
            if (!smooth) continue;
            double const distance = segment_distance(centre, places_[caps_[t][1]], places_[caps_[t][2]]) - radius;
            if (distance > 0) slope += s.edge / (distance * distance);
            // Beyond half a sphere on either side no level can hold.
            smooth = distance > 0 && slope * radius <= 2 * pi && !reaches(centre, radius, t);
        }
        blur_[depth + 1] = blur;
        far_slope_[depth + 1] = far_slope;
        if (!smooth) return false;
        double const change = slope * radius / (4 * pi) * 1.001 + blur * 1.001 + 0x1p-36;
        double const here = share(centre, kept);
        level_ = level_of(here - change);
        return level_ == level_of(here + change);
    }
    /// Whether a cap comes into the ball.
    [[nodiscard]] bool reaches(vec3 const& p, double radius, std::size_t t) const noexcept {
        shape const& s = shapes_[t];
        vec3 const off = p - s.centre;
        if (std::fabs(dot(s.normal, off)) > radius * s.double_area || length(off) > radius + s.radius) return false;
        std::array<vec3, 3> const c{places_[caps_[t][0]], places_[caps_[t][1]], places_[caps_[t][2]]};
        bool above = true;
        for (std::size_t e = 0; e < 3; ++e) {
            vec3 const& a = c[e];
            vec3 const& b = c[(e + 1) % 3];
            if (segment_distance(p, a, b) <= radius) return true;
            above = above && dot(cross(s.normal, b - a), p - a) >= 0;
        }
        return above;
    }
    [[nodiscard]] static double segment_distance(vec3 const& p, vec3 const& a, vec3 const& b) noexcept {
        vec3 const along = b - a;
        double const square = squared_length(along);
        double const t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
        return length(p - a - t * along);
    }

    /// Solid angle of caps over that of the sphere, positive from behind them. O(caps).
    double share(vec3 const& p, std::vector<std::uint32_t> const& which) {
        ++round_;
        double halves = 0;
        for (std::uint32_t const t : which) {
            auto const [i, j, k] = caps_[t];
            for (std::uint32_t const v : caps_[t]) {
                if (seen_[v] == round_) continue;
                seen_[v] = round_;
                offsets_[v] = places_[v] - p;
                lengths_[v] = length(offsets_[v]);
            }
            vec3 const& a = offsets_[i];
            vec3 const& b = offsets_[j];
            vec3 const& c = offsets_[k];
            // Half of the solid angle of a triangle [van Oosterom, Strackee 1983].
            double const volume = dot(a, shapes_[t].normal);
            double const rest = lengths_[i] * lengths_[j] * lengths_[k] + dot(a, b) * lengths_[k] +
                                dot(b, c) * lengths_[i] + dot(c, a) * lengths_[j];
            double const half = angle(std::fabs(volume), rest);
            halves += volume < 0 ? -half : half;
        }
        return halves / (2 * pi);
    }
    /// atan2(y, x) for y >= 0, from sums that every machine rounds alike.
    [[nodiscard]] static double angle(double y, double x) noexcept {
        double const h = std::sqrt(x * x + y * y);
        if (!(h > 0)) return 0;
        double const wide = std::fabs(x);
        double const a = y <= wide ? 0.5 * pi - elementary::acos(std::min(y / h, 1.0)) : elementary::acos(std::min(wide / h, 1.0));
        return x < 0 ? pi - a : a;
    }
    row_crossings const& rows_;
    std::array<std::size_t, 3> size_;
    std::array<double, 3> scale_{};
    std::vector<cap> caps_;
    std::vector<vec3> places_{};
    std::vector<shape> shapes_{};
    std::vector<vec3> offsets_{};
    std::vector<double> lengths_{};
    std::vector<std::uint64_t> seen_{};  ///< the evaluation that offset and length of a corner belong to
    std::uint64_t round_ = 0;
    std::array<std::vector<std::uint32_t>, 8> active_{};
    std::array<double, 8> blur_{};
    std::array<double, 8> far_slope_{};  ///< what edges of caps that do not count add to the gradient, at most
    voxel low_{};
    int level_ = 1;
    std::vector<int> levels_{};
};

}  // namespace tafoni::detail

#endif
