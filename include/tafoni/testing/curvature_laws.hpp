/// \file
/// Law checks for estimators of curvature.
#ifndef TAFONI_TESTING_CURVATURE_LAWS_HPP
#define TAFONI_TESTING_CURVATURE_LAWS_HPP

#include <tafoni/curvature/concepts.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tafoni::laws {

namespace detail {

/// Runs blocks from the last to the first and says that it has several threads.
struct backward_executor {
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        if (grain == 0) grain = 1;
        for (std::size_t b = (n + grain - 1) / grain * grain; b >= grain; b -= grain) {
            f(b - grain, std::min(b, n));
        }
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return 4; }
};

struct small_surface {
    std::vector<vec3> positions{};
    std::vector<std::array<std::uint32_t, 3>> triangles{};

    template <class Estimator, executor E = inline_executor>
    [[nodiscard]] std::vector<double> curvature(Estimator const& e, E const& x = {}) const {
        vertex_rings const rings(positions.size(), triangles);
        std::vector<double> mean(positions.size(), std::numeric_limits<double>::quiet_NaN());
        e(surface_view{.positions = positions, .triangles = triangles, .rings = &rings}, mean, x);
        return mean;
    }
};

/// Latitudes and longitudes of the unit sphere, from rational parameters of the circle.
[[nodiscard]] inline small_surface globe(std::uint32_t n) {
    small_surface s;
    auto const circle = [](double t) { return std::array<double, 2>{(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)}; };
    auto const around = [&](std::uint32_t k, std::uint32_t of) {
        std::uint32_t const quarter = 4 * k / of;
        auto const [c, d] = circle(0.41421356 * (2.0 * (4 * k % of) / of - 1));
        double const r = 0.70710678118654757;
        std::array<double, 2> p{r * (c - d), r * (c + d)};
        for (std::uint32_t q = 0; q < quarter; ++q) p = {-p[1], p[0]};
        return p;
    };
    s.positions.push_back(vec3{0, 0, -1});
    for (std::uint32_t j = 1; j < n; ++j) {
        auto const lat = around(j, 2 * n);  // (cosine, sine) of the angle from the south pole
        double const m = std::sqrt(lat[0] * lat[0] + lat[1] * lat[1]);
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            auto const lon = around(i, 2 * n);
            double const l = std::sqrt(lon[0] * lon[0] + lon[1] * lon[1]);
            s.positions.push_back(vec3{lat[1] / m * lon[0] / l, lat[1] / m * lon[1] / l, -lat[0] / m});
        }
    }
    s.positions.push_back(vec3{0, 0, 1});
    auto const top = static_cast<std::uint32_t>(s.positions.size() - 1);
    auto const at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (j - 1) * 2 * n + i % (2 * n); };
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
        s.triangles.push_back({0, at(i + 1, 1), at(i, 1)});
        s.triangles.push_back({top, at(i, n - 1), at(i + 1, n - 1)});
        for (std::uint32_t j = 1; j + 1 < n; ++j) {
            s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return s;
}

}  // namespace detail

/// Curvature estimator: what the concept's comment asks for, on small meshes of its own. Returns the broken laws.
template <curvature_estimator Estimator>
[[nodiscard]] std::vector<std::string> curvature(Estimator const& estimator) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    auto const finite = [](std::vector<double> const& m) {
        return std::all_of(m.begin(), m.end(), [](double h) { return std::isfinite(h); });
    };
    auto const same = [](std::vector<double> const& a, std::vector<double> const& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
            return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
        });
    };

    detail::small_surface const ball = detail::globe(8);
    auto const h = ball.curvature(estimator);
    law(finite(h), "every entry is written and finite");
    law(std::all_of(h.begin(), h.end(), [](double x) { return x > 0.5 && x < 1.6; }), "1 / R on a sphere whose triangles face out");
    law(same(h, ball.curvature(estimator)), "pure: equal calls give equal answers");
    law(same(h, ball.curvature(estimator, detail::backward_executor{})), "equal for every executor");

    detail::small_surface hollow = ball;
    for (auto& t : hollow.triangles) std::swap(t[1], t[2]);
    auto const inward = hollow.curvature(estimator);
    law(std::all_of(inward.begin(), inward.end(), [](double x) { return x < -0.5 && x > -1.6; }), "negative in hollows");

    detail::small_surface large = ball;
    for (vec3& p : large.positions) p = vec3{4 * p[0], 4 * p[1], 4 * p[2]};
    auto const quarter = large.curvature(estimator);
    bool scales = quarter.size() == h.size();
    for (std::size_t v = 0; scales && v < h.size(); ++v) scales = std::fabs(4 * quarter[v] - h[v]) <= 1e-9;
    law(scales, "scaling the mesh by s scales the result by 1 / s");

    // An open sheet with a triangle of no area, a vertex of no triangle and a corner named twice.
    detail::small_surface sheet;
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) sheet.positions.push_back(vec3{static_cast<double>(x), static_cast<double>(y), 0.0});
    }
    for (std::uint32_t y = 0; y < 4; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) {
            std::uint32_t const p = x + 5 * y;
            sheet.triangles.push_back({p, p + 1, p + 6});
            sheet.triangles.push_back({p, p + 6, p + 5});
        }
    }
    auto const flat = sheet.curvature(estimator);
    law(finite(flat) && std::all_of(flat.begin(), flat.end(), [](double x) { return std::fabs(x) < 1e-9; }),
        "0 on a plane, at its border too");
    sheet.positions.push_back(vec3{9, 9, 9});
    sheet.positions.push_back(sheet.positions[0]);
    sheet.triangles.push_back({0, 25, 0});
    sheet.triangles.push_back({1, 2, 3});
    sheet.triangles.push_back({0, 26, 1});
    auto const odd = sheet.curvature(estimator);
    law(finite(odd), "finite on flat triangles, lone vertices and points that coincide");
    law(odd[25] == 0, "0 at a vertex without triangles");
    law(detail::small_surface{}.curvature(estimator).empty(), "an empty mesh has no entries");
    return broken;
}

}  // namespace tafoni::laws

#endif
