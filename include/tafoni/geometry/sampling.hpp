/// \file
/// Random points on the surface of a solid.
#ifndef TAFONI_GEOMETRY_SAMPLING_HPP
#define TAFONI_GEOMETRY_SAMPLING_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/solid.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tafoni {

/// Draws points uniformly by area. Views the solid, which must outlive it.
class surface_sampler {
public:
    /// O(triangles).
    explicit surface_sampler(solid const& s) : solid_(&s) {
        below_.reserve(s.triangles.size());
        double sum = 0;
        for (auto const& t : s.triangles) {
            vec3 const u = s.positions[t[1]] - s.positions[t[0]];
            vec3 const v = s.positions[t[2]] - s.positions[t[0]];
            sum += 0.5 * length(cross(u, v));
            below_.push_back(sum);
        }
    }

    /// A point on the surface up to rounding, within the solid's bounds. Three draws. O(log triangles).
    [[nodiscard]] vec3 operator()(stream& random) const noexcept {
        double const x = random.uniform01() * below_.back();
        double a = random.uniform01();
        double b = random.uniform01();
        auto const found = std::upper_bound(below_.begin(), below_.end() - 1, x);
        auto const& t = solid_->triangles[static_cast<std::size_t>(found - below_.begin())];
        if (a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        vec3 const& p = solid_->positions[t[0]];
        vec3 const u = solid_->positions[t[1]] - p;
        vec3 const v = solid_->positions[t[2]] - p;
        vec3 r{0, 0, 0};
        for (int k = 0; k < 3; ++k) {
            double const x_k = p[k] + a * u[k] + b * v[k];
            r[k] = std::clamp(x_k, solid_->bounds.lo[k], solid_->bounds.hi[k]);
        }
        return r;
    }

private:
    solid const* solid_;
    std::vector<double> below_{};  // area of the triangles up to and with this one
};

}  // namespace tafoni

#endif
