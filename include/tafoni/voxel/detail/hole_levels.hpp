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
/// share S of the full sphere that the caps take up. S is smooth off the caps. Seen from far enough, a cluster of holes
/// is one dipole at its middle [Barill et al. 2018], with an error of at most area radius / (2 pi distance^3) and a
/// gradient of at most 2 area / (4 pi distance^3); of nearer holes the gradient is at most
/// sum(length / distance^2) / 4 pi over their edges (Biot and Savart's law). Where these bounds keep S within one level
/// all over a block, one evaluation decides the block. Others are halved, down to single voxels, which the sum over
/// all caps decides where bounds do not. No centre of a voxel may lie on a cap, where S jumps: `cap_holes` puts
/// the apexes out of the way. Asked as `fill_bricks` does.
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
        all_.resize(caps_.size());
        std::iota(all_.begin(), all_.end(), 0U);
        cluster_holes();
    }

    [[nodiscard]] bool is_uniform(voxel low) {
        if (caps_.empty()) return true;
        low_ = low;
        if (decided(low, 32)) return true;
        levels_.resize(32768);
        split(low, 32);
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

    void split(voxel low, std::int32_t edge) {
        if (edge == 1) {
            set(low, 1, level_at(centre_of(in_rows(low))));
            return;
        }
        std::int32_t const half = edge / 2;
        for (std::int32_t child = 0; child < 8; ++child) {
            voxel const at{low.x + half * (child & 1), low.y + half * (child >> 1 & 1), low.z + half * (child >> 2)};
            if (static_cast<std::size_t>(at.x) >= size_[0] || static_cast<std::size_t>(at.y) >= size_[1] ||
                static_cast<std::size_t>(at.z) >= size_[2]) {
                continue;
            }
            if (half > 1 && decided(at, half)) {
                set(at, half, level_);
            } else {
                split(at, half);
            }
        }
    }
    [[nodiscard]] int level_at(vec3 const& p) {
        for (double care = 1; care < 1000; care *= 16) {
            view const seen = look(p, 0, care);
            double const change = seen.blur * 1.001 + 0x1p-36;
            int const level = level_of(seen.share - change);
            if (level == level_of(seen.share + change)) return level;
        }
        return level_of(share(p, all_));
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

    /// Whether one level holds for all voxels of a block; `level_` is it then.
    bool decided(voxel low, std::int32_t edge) {
        voxel const high{std::min(low.x + edge, static_cast<std::int32_t>(size_[0])) - 1,
                         std::min(low.y + edge, static_cast<std::int32_t>(size_[1])) - 1,
                         std::min(low.z + edge, static_cast<std::int32_t>(size_[2])) - 1};
        vec3 const a = centre_of(in_rows(low));
        vec3 const b = centre_of(in_rows(high));
        double const radius = 0.5 * length(b - a) + 0x1p-20;
        view const seen = look(vec3(0.5 * (a + b)), radius, 1);
        if (!seen.smooth) return false;
        double const change = seen.slope * radius / (4 * pi) * 1.001 + seen.blur * 1.001 + 0x1p-36;
        level_ = level_of(seen.share - change);
        return level_ == level_of(seen.share + change);
    }

    /// S at the middle of a ball within `blur`, and 4 pi times what its gradient is at most in the ball; of no use where
    /// not `smooth`. The more care the less blur. O(log holes + caps of near holes).
    struct view {
        double share = 0;
        double blur = 0;
        double slope = 0;
        bool smooth = true;
    };
    view look(vec3 const& p, double radius, double care) {
        view out;
        ++round_;
        double halves = 0;
        double const negligible = 0.05 / (care * static_cast<double>(caps_.size()));
        due_.assign(1, 0);
        while (!due_.empty()) {
            cluster const& c = clusters_[due_.back()];
            due_.pop_back();
            vec3 const there = c.centre - p;
            double const far_off = length(there);
            double const off = far_off - radius - c.radius;
            if (off > 0 && off > 4 * care * c.radius) {
                double const cube = off * off * off;
                out.share += dot(c.dipole, there) / (4 * pi * far_off * far_off * far_off);
                out.blur += c.area * c.radius / (2 * pi * cube);
                out.slope += 2 * c.area / cube;
                continue;
            }
            if (c.second != 0) {
                due_.push_back(c.second);
                due_.push_back(c.first);
                continue;
            }
            for (std::uint32_t n = c.begin; n < c.end; ++n) {
                std::uint32_t const t = by_hole_[n];
                shape const& s = shapes_[t];
                double const gap = length(p - s.centre) - radius - s.radius;
                if (gap > 0 && s.double_area < 8 * pi * negligible * gap * gap) {
                    out.blur += s.double_area / (8 * pi * gap * gap);
                    out.slope += s.edge / (gap * gap);
                    continue;
                }
                halves += half_of(t, p);
                if (radius == 0) continue;
                double const distance = segment_distance(p, places_[caps_[t][1]], places_[caps_[t][2]]) - radius;
                if (distance > 0) out.slope += s.edge / (distance * distance);
                // Beyond half a sphere on either side no level can hold.
                out.smooth = distance > 0 && out.slope * radius <= 2 * pi && !reaches(p, radius, t);
                if (!out.smooth) return out;
            }
        }
        out.share += halves / (2 * pi);
        return out;
    }

    /// Holes that are seen as one from far away: all caps of a hole are in the same clusters.
    struct cluster {
        vec3 centre{0, 0, 0};
        double radius = 0;
        vec3 dipole{0, 0, 0};     ///< sum of area times normal
        double area = 0;
        std::uint32_t begin = 0;  ///< caps in `by_hole_`
        std::uint32_t end = 0;
        std::uint32_t first = 0;  ///< halves; of a single hole none
        std::uint32_t second = 0;
    };
    /// O(caps log^2 holes).
    void cluster_holes() {
        if (caps_.empty()) return;
        by_hole_ = all_;
        std::sort(by_hole_.begin(), by_hole_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return caps_[a][0] != caps_[b][0] ? caps_[a][0] < caps_[b][0] : a < b;
        });
        struct hole {
            std::uint32_t begin, end;
        };
        std::vector<hole> holes;
        for (std::uint32_t n = 0; n < by_hole_.size(); ++n) {
            if (n == 0 || caps_[by_hole_[n]][0] != caps_[by_hole_[n - 1]][0]) holes.push_back({n, n});
            holes.back().end = n + 1;
        }
        struct part {
            std::size_t begin, end;
            std::uint32_t at;
        };
        auto const apex = [&](hole const& h) -> vec3 const& { return places_[caps_[by_hole_[h.begin]][0]]; };
        clusters_.emplace_back();
        // Halves are cut at the middle hole along the longest side of the box of their apexes; their caps stay together.
        std::vector<std::uint32_t> order;
        order.reserve(by_hole_.size());
        std::vector<part> parts{{0, holes.size(), 0}};
        while (!parts.empty()) {
            part const now = parts.back();
            parts.pop_back();
            if (now.end - now.begin == 1) {
                hole const& h = holes[now.begin];
                clusters_[now.at].begin = static_cast<std::uint32_t>(order.size());
                order.insert(order.end(), by_hole_.begin() + h.begin, by_hole_.begin() + h.end);
                clusters_[now.at].end = static_cast<std::uint32_t>(order.size());
                continue;
            }
            box3 box;
            for (std::size_t h = now.begin; h < now.end; ++h) box.include(apex(holes[h]));
            vec3 const extent = box.extent();
            Eigen::Index const d = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : extent[1] >= extent[2] ? 1 : 2;
            auto const from = holes.begin() + static_cast<std::ptrdiff_t>(now.begin);
            std::sort(from, holes.begin() + static_cast<std::ptrdiff_t>(now.end), [&](hole const& a, hole const& b) {
                return apex(a)[d] != apex(b)[d] ? apex(a)[d] < apex(b)[d] : a.begin < b.begin;
            });
            std::size_t const middle = now.begin + (now.end - now.begin) / 2;
            auto const next = static_cast<std::uint32_t>(clusters_.size());
            clusters_.resize(clusters_.size() + 2);
            clusters_[now.at].first = next;
            clusters_[now.at].second = next + 1;
            parts.push_back({middle, now.end, next + 1});
            parts.push_back({now.begin, middle, next});
        }
        by_hole_ = std::move(order);
        // Halves are numbered after what they are halves of.
        for (std::size_t n = clusters_.size(); n-- > 0;) measure(clusters_[n]);
    }
    void measure(cluster& c) {
        if (c.second != 0) {
            c.begin = clusters_[c.first].begin;
            c.end = clusters_[c.second].end;
        }
        for (std::uint32_t n = c.begin; n < c.end; ++n) {
            shape const& s = shapes_[by_hole_[n]];
            c.area += 0.5 * s.double_area;
            c.dipole += 0.5 * s.normal;
            c.centre += vec3(0.5 * s.double_area * s.centre);
        }
        c.centre = c.area > 0 ? vec3(c.centre / c.area) : shapes_[by_hole_[c.begin]].centre;
        for (std::uint32_t n = c.begin; n < c.end; ++n) {
            shape const& s = shapes_[by_hole_[n]];
            c.radius = std::max(c.radius, (length(s.centre - c.centre) + s.radius) * (1 + 0x1p-40));
        }
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
        for (std::uint32_t const t : which) halves += half_of(t, p);
        return halves / (2 * pi);
    }
    /// Half of the solid angle of a cap [van Oosterom, Strackee 1983]; p stays the same for one `round_`.
    double half_of(std::uint32_t t, vec3 const& p) {
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
        double const volume = dot(a, shapes_[t].normal);
        double const rest = lengths_[i] * lengths_[j] * lengths_[k] + dot(a, b) * lengths_[k] +
                            dot(b, c) * lengths_[i] + dot(c, a) * lengths_[j];
        double const half = angle(std::fabs(volume), rest);
        return volume < 0 ? -half : half;
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
    std::vector<std::uint32_t> all_{};      ///< caps in the order in which they are summed
    std::vector<std::uint32_t> by_hole_{};  ///< caps, those of a cluster together
    std::vector<cluster> clusters_{};       ///< the first holds all
    std::vector<std::uint32_t> due_{};
    voxel low_{};
    int level_ = 1;
    std::vector<int> levels_{};
};

}  // namespace tafoni::detail

#endif
