#include "support/curved_surfaces.hpp"
#include "support/test_data.hpp"

#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Nodes of the largest stream of a terrain, from its source to the border: every node drains to the neighbour that a
/// flood from the border comes from, and the stream goes up from the outlet by the larger feeder.
std::vector<std::size_t> largest_stream(height_grid const& g) {
    std::size_t const n = g.heights.size();
    std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>, std::greater<>> shore;
    std::vector<std::size_t> to(n, n);
    std::vector<unsigned char> seen(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t const r = i / g.columns;
        std::size_t const c = i % g.columns;
        if (r > 0 && c > 0 && r + 1 < g.rows && c + 1 < g.columns) continue;
        seen[i] = 1;
        shore.emplace(g.heights[i], i);
    }
    std::vector<std::size_t> order;
    while (!shore.empty()) {
        auto const [z, i] = shore.top();
        shore.pop();
        order.push_back(i);
        std::size_t const r = i / g.columns;
        std::size_t const c = i % g.columns;
        for (std::size_t a = r - std::min<std::size_t>(r, 1); a <= std::min(r + 1, g.rows - 1); ++a) {
            for (std::size_t b = c - std::min<std::size_t>(c, 1); b <= std::min(c + 1, g.columns - 1); ++b) {
                std::size_t const j = a * g.columns + b;
                if (seen[j] != 0) continue;
                seen[j] = 1;
                to[j] = i;
                shore.emplace(std::max(z, g.heights[j]), j);
            }
        }
    }
    std::vector<std::size_t> area(n, 1);
    std::vector<std::size_t> feeder(n, n);
    for (std::size_t k = n; k-- > 0;) {
        std::size_t const i = order[k];
        std::size_t const t = to[i];
        if (t == n) continue;
        area[t] += area[i];
        if (feeder[t] == n || area[i] > area[feeder[t]]) feeder[t] = i;
    }
    std::vector<std::size_t> path;
    auto const outlet = std::max_element(area.begin(), area.end()) - area.begin();
    for (auto at = static_cast<std::size_t>(outlet); at != n; at = feeder[at]) path.push_back(at);
    std::reverse(path.begin(), path.end());
    return path;
}

/// A piece of a terrain around a bend of its largest stream.
struct valley {
    triangle_surface ground{};
    std::vector<vec3> course{};  ///< of the stream through the piece, node by node
    std::size_t bend = 0;        ///< the node of the course
    double turn = 0;             ///< of the course there, radians, positive to the left
    double cell = 1;
    box3 bounds{};

    /// Where the course leads at its node k, unit.
    [[nodiscard]] vec3 way(std::size_t k) const {
        vec3 const d{course[std::min(k + 3, course.size() - 1)] - course[k - std::min<std::size_t>(k, 3)]};
        return normalized(d);
    }
    /// The node of the course nearest in plan.
    [[nodiscard]] std::pair<std::size_t, double> nearest(vec3 const& p) const {
        std::pair<std::size_t, double> best{0, std::numeric_limits<double>::infinity()};
        for (std::size_t k = 0; k < course.size(); ++k) {
            double const x = p[0] - course[k][0];
            double const y = p[1] - course[k][1];
            double const d = std::sqrt(x * x + y * y);
            if (d < best.second) best = {k, d};
        }
        return best;
    }
};

/// The sharpest bend over `arm` nodes up and down of the stream where the ground rises by a cell or more within four
/// cells on both sides, with `side` x `side` nodes of the terrain around it.
valley sharpest_bend(height_grid const& g, std::size_t side) {
    constexpr std::size_t arm = 9;
    constexpr std::size_t rim = 8;
    std::vector<std::size_t> const path = largest_stream(g);
    auto const row = [&](std::size_t k) { return path[k] / g.columns; };
    auto const column = [&](std::size_t k) { return path[k] % g.columns; };
    auto const at = [&](std::size_t k) { return g.position(row(k), column(k)); };
    auto const rise = [&](std::size_t k, double towards) {  // across the stream
        vec3 const d{at(k + 3) - at(k - 3)};
        double const l = std::sqrt(d[0] * d[0] + d[1] * d[1]);
        double most = 0;
        for (double far = 2; far <= 4; ++far) {
            auto const r = static_cast<double>(row(k)) - towards * far * d[0] / l;
            auto const c = static_cast<double>(column(k)) - towards * far * d[1] / l;
            most = std::max(most, g.height(static_cast<std::size_t>(r + 0.5), static_cast<std::size_t>(c + 0.5)) - at(k)[2]);
        }
        return most;
    };
    valley out;
    std::size_t best = 0;
    for (std::size_t k = arm; k + arm < path.size(); ++k) {
        if (std::min({row(k), column(k), g.rows - 1 - row(k), g.columns - 1 - column(k)}) < rim) continue;
        if (std::min(rise(k, -1), rise(k, 1)) < g.cell_size_x) continue;
        vec3 const a{at(k) - at(k - arm)};
        vec3 const b{at(k + arm) - at(k)};
        double const t = std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        if (std::fabs(t) <= std::fabs(out.turn)) continue;
        out.turn = t;
        best = k;
    }
    REQUIRE(best > 0);
    auto const first_of = [&](std::size_t middle, std::size_t n) { return std::min(middle - std::min(middle, side / 2), n - side); };
    std::size_t const top = first_of(row(best), g.rows);
    std::size_t const left = first_of(column(best), g.columns);
    height_grid piece{.columns = side, .rows = side, .cell_size_x = g.cell_size_x, .cell_size_y = g.cell_size_y};
    for (std::size_t r = top; r < top + side; ++r) {
        for (std::size_t c = left; c < left + side; ++c) piece.heights.push_back(g.height(r, c));
    }
    out.ground = triangles_of(detail::terrain_top(piece));
    out.cell = g.cell_size_x;
    for (vec3 const& p : out.ground.positions) out.bounds.include(p);
    auto const inside = [&](std::size_t k) {
        return row(k) >= top + 3 && row(k) + 3 < top + side && column(k) >= left + 3 && column(k) + 3 < left + side;
    };
    std::size_t first = best;
    std::size_t last = best;
    while (first > 0 && inside(first - 1)) --first;
    while (last + 1 < path.size() && inside(last + 1)) ++last;
    for (std::size_t k = first; k <= last; ++k) out.course.push_back(piece.position(row(k) - top, column(k) - left));
    out.bend = best - first;
    return out;
}

/// Water that is let into a valley at the upper end of its course, in metres and seconds.
struct inflow {
    double speed = 10;     ///< m / s
    double wide = 3;       ///< cells
    double deep = 2;       ///< cells
    double fine = 0.6;     ///< spacing of particles or radius of drops, cells
    std::uint32_t particles = 1500;
    double friction = 0;   ///< of a stream, over sqrt(g / spacing)

    [[nodiscard]] box_emitter source(valley const& v) const {
        vec3 const s = v.course[1];
        double const half = 0.5 * wide * v.cell;
        double ground = s[2];  // the highest under the box, so that no water begins in rock
        for (vec3 const& p : v.ground.positions) {
            if (std::fabs(p[0] - s[0]) <= half + v.cell && std::fabs(p[1] - s[1]) <= half + v.cell) ground = std::max(ground, p[2]);
        }
        box3 box;
        box.lo = vec3{s[0] - half, s[1] - half, ground + fine * v.cell};
        box.hi = vec3{s[0] + half, s[1] + half, ground + (fine + deep) * v.cell};
        return {.box = box, .velocity = vec3{speed * v.way(1)}};
    }
    [[nodiscard]] box_sink drain(valley const& v) const {
        double const rim = 2.5 * v.cell;
        box3 keep;
        keep.lo = vec3{v.bounds.lo[0] + rim, v.bounds.lo[1] + rim, v.bounds.lo[2] - 6 * rim};
        keep.hi = vec3{v.bounds.hi[0] - rim, v.bounds.hi[1] - rim, v.bounds.hi[2] + 6 * rim};
        return {.keep = keep};
    }
    [[nodiscard]] double frame(valley const& v) const { return 0.1 * std::sqrt(0.1 * v.cell); }
    [[nodiscard]] sph<float> stream(valley const& v) const {
        return sph<float>(source(v), drain(v),
                          {.particles = particles, .spacing = fine * v.cell, .sound_speed = 100 * std::sqrt(fine * v.cell), .friction = friction * std::sqrt(9.81 / (fine * v.cell)), .gravity = vec3{0, 0, -9.81}, .frame = frame(v)});
    }
    [[nodiscard]] rain_particles drops(valley const& v) const {
        return rain_particles(source(v), drain(v),
                              {.particles = particles, .radius = fine * v.cell, .gravity = vec3{0, 0, -9.81}, .friction = 0.3 / std::sqrt(0.1 * v.cell),
                               .frame = frame(v), .lifetime = 60 * std::sqrt(0.1 * v.cell)});
    }
};

partheniades_erosion shear_of(double coefficient) { return {.coefficient = coefficient, .critical = 1}; }

/// Mean of a number over the vertices of the banks around the bend: on the outer side of the course, and on the inner.
std::pair<double, double> on_banks(valley const& v, auto const& number) {
    std::array<double, 2> sum{};
    std::array<double, 2> count{};
    for (std::size_t i = 0; i < v.ground.positions.size(); ++i) {
        vec3 const& p = v.ground.positions[i];
        auto const [k, far] = v.nearest(p);
        if (k + 8 < v.bend || k > v.bend + 8 || far < 0.75 * v.cell || far > 4 * v.cell) continue;
        vec3 const w = v.way(k);
        double const left = w[0] * (p[1] - v.course[k][1]) - w[1] * (p[0] - v.course[k][0]);
        std::size_t const inner = left * v.turn > 0 ? 1 : 0;
        sum[inner] += number(i);
        ++count[inner];
    }
    REQUIRE(std::min(count[0], count[1]) > 30);
    return {sum[0] / count[0], sum[1] / count[1]};
}

/// Vertices from which water stayed away by more than `edges`.
std::vector<std::size_t> dry(triangle_surface const& s, std::span<std::uint64_t const> flow, int edges) {
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<unsigned char> wet(s.positions.size());
    for (std::size_t v = 0; v < wet.size(); ++v) wet[v] = flow[v] > 0 ? 1 : 0;
    for (int k = 0; k < edges; ++k) {
        std::vector<unsigned char> const before = wet;
        for (std::size_t v = 0; v < wet.size(); ++v) {
            for (std::uint32_t const w : rings.neighbors(v)) wet[v] |= before[w];
        }
    }
    std::vector<std::size_t> out;
    for (std::size_t v = 0; v < wet.size(); ++v) {
        if (wet[v] == 0) out.push_back(v);
    }
    return out;
}

/// Volume between the surface and the plane z = 0.
double below(triangle_surface const& s, vec3 const& o) {
    double six = 0;
    for (auto const& t : s.triangles) {
        vec3 const a{s.positions[t[0]] - o};
        vec3 const b{s.positions[t[1]] - o};
        vec3 const c{s.positions[t[2]] - o};
        six += (a[2] + b[2] + c[2]) * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return six / 6;
}

/// What holds of every stream, whatever the fluid and the model.
void check_stream(valley const& v, auto const& run) {
    auto const& after = run.surface().positions;
    auto const& before = v.ground.positions;
    // What it touches is worn, and what stays dry is the same to the bit.
    std::size_t touched = 0;
    std::size_t worn = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (run.flow()[i] < 100) continue;
        ++touched;
        worn += run.wear()[i] > 0 ? 1U : 0U;
    }
    CHECK(touched > 60);
    CHECK(static_cast<double>(worn) > 0.95 * static_cast<double>(touched));
    std::vector<std::size_t> const away = dry(v.ground, run.flow(), 2);
    CHECK(away.size() > before.size() / 2);
    std::size_t moved = 0;
    for (std::size_t const i : away) moved += after[i] == before[i] && run.wear()[i] == 0 ? 0U : 1U;
    CHECK(moved == 0);
    // The ledger closes, and tells of the volume between the surfaces.
    CHECK(run.balanced());
    sediment_ledger const& l = run.report().ledger;
    CHECK(l.eroded > 0);
    CHECK(l.eroded == Approx(l.deposited + l.carried + l.left).epsilon(1e-12));
    CHECK(below(v.ground, v.bounds.lo) - below(run.surface(), v.bounds.lo) == Approx(l.eroded - l.deposited).epsilon(1e-6));
    CHECK(self_intersections(run.surface().positions, run.surface().triangles).empty());
}

/// How far the bed is lower on the mean, where the stream ran.
double cut(valley const& v, auto const& run) {
    double sum = 0;
    double n = 0;
    for (std::size_t i = 0; i < v.ground.positions.size(); ++i) {
        if (run.flow()[i] == 0 || v.nearest(v.ground.positions[i]).second > 0.1 * v.cell) continue;
        sum += v.ground.positions[i][2] - run.surface().positions[i][2];
        ++n;
    }
    REQUIRE(n > 15);
    return sum / n;
}

/// How far a vertex that has moved stands over the heights of a terrain, at most.
double highest_over(triangle_surface const& terrain, triangle_surface const& after) {
    double most = -std::numeric_limits<double>::infinity();
    auto const& q = terrain.positions;
    for (std::size_t i = 0; i < q.size(); ++i) {
        vec3 const p = after.positions[i];
        if (p == q[i]) continue;
        for (auto const& t : terrain.triangles) {
            auto const side = [&](vec3 const& a, vec3 const& b) { return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]); };
            double const a = side(q[t[1]], q[t[2]]);
            double const b = side(q[t[2]], q[t[0]]);
            double const c = side(q[t[0]], q[t[1]]);
            if (a < 0 || b < 0 || c < 0) continue;
            most = std::max(most, p[2] - (a * q[t[0]][2] + b * q[t[1]][2] + c * q[t[2]][2]) / (a + b + c));
        }
    }
    return most;
}

constexpr char const* ridge = "dems/bigtujunga_ridge128_30m.asc";
constexpr char const* alps = "dems/stubai_10m.asc";

/// Calls `f` with the bend of a real terrain, if it is there.
void in_valley(char const* name, std::size_t side, auto const& f) {
    auto const path = find(name);
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    valley const v = sharpest_bend(read_esri_ascii(path), side);
    INFO(name << ": turns by " << v.turn << " rad at " << v.course[v.bend][0] << ", " << v.course[v.bend][1]);
    REQUIRE(v.course.front()[2] > v.course.back()[2] + 2 * v.cell);
    REQUIRE(std::fabs(v.turn) > 0.5);
    f(v);
}

}  // namespace

TEST_CASE("a stream in a real valley cuts its bed and wears the outer bank of a bend most", "[slow]") {
    in_valley(GENERATE(ridge, alps), 45, [](valley const& v) {
        hydraulic_run run(v.ground, inflow{}.stream(v), shear_of(0.5), {.step_divisor = 50});
        run.run(400);
        check_stream(v, run);
        CHECK(cut(v, run) > 0.05 * v.cell);
        auto const [outer, inner] = on_banks(v, [&](std::size_t i) { return run.wear()[i]; });
        CAPTURE(outer, inner);
        CHECK(outer > 1.4 * inner);
        CHECK(inner > 0);
    });
}

TEST_CASE("a stream erodes a real valley by curvature, never outwards, and its outer bank most", "[slow]") {
    in_valley(GENERATE(ridge, alps), 45, [](valley const& v) {
        hydraulic_run run(v.ground, inflow{}.stream(v), curvature_erosion<>{}, {.step_divisor = 50});
        // Tips that cannot go in slide along the faces at them: not out by the normal of those, weighted by area.
        double farthest = 0;
        std::vector<vec3> normal(v.ground.positions.size());
        vertex_rings const rings(v.ground.positions.size(), v.ground.triangles);
        for (int k = 0; k < 300; ++k) {
            std::vector<vec3> const then = run.surface().positions;
            vertex_normals({.positions = then, .triangles = v.ground.triangles, .rings = &rings}, normal, inline_executor{});
            std::vector<vec3> by_area(then.size(), vec3{0, 0, 0});
            for (auto const& t : v.ground.triangles) {
                vec3 const n = cross(vec3{then[t[1]] - then[t[0]]}, vec3{then[t[2]] - then[t[0]]});
                for (std::uint32_t const c : t) by_area[c] += n;
            }
            run.run(1);
            for (std::size_t i = 0; i < then.size(); ++i) {
                vec3 const way{run.surface().positions[i] - then[i]};
                farthest = std::max(farthest, std::min(dot(way, normal[i]), dot(way, normalized(by_area[i]))));
            }
        }
        CHECK(farthest < 1e-4 * v.cell);
        CHECK(highest_over(v.ground, run.surface()) <= 0);
        check_stream(v, run);
        CHECK(run.report().ledger.deposited == 0);
        auto const [outer, inner] = on_banks(v, [&](std::size_t i) { return run.wear()[i]; });
        CAPTURE(outer, inner);
        CHECK(outer > 1.1 * inner);
    });
}

TEST_CASE("a faster stream and a deeper one wear a real valley more", "[slow]") {
    in_valley(GENERATE(ridge, alps), 45, [](valley const& v) {
        auto const eroded = [&](inflow const& in) {
            hydraulic_run run(v.ground, in.stream(v), shear_of(0.3), {.step_divisor = 50});
            run.run(250);
            CHECK(run.balanced());
            return run.report().ledger.eroded;
        };
        double const slow = eroded({});
        CHECK(slow > 0);
        CHECK(eroded({.speed = 30}) > 1.4 * slow);
        CHECK(eroded({.deep = 4}) > 1.2 * slow);
    });
}

TEST_CASE("friction keeps a stream in a real valley to its bed", "[slow]") {
    in_valley(GENERATE(ridge, alps), 45, [](valley const& v) {
        struct run_of {
            double speed = 0;     // mean of the particles, at the end
            double touching = 0;  // nodes of the course that the water ran over
        };
        auto const of = [&](double friction) {
            hydraulic_run run(v.ground, inflow{.friction = friction}.stream(v), shear_of(0));
            run.run(300);
            CHECK(run.report().ledger.eroded == 0);
            run_of out;
            auto const n = run.fluid().particle_count();
            for (std::size_t i = 0; i < n; ++i) out.speed += length(run.fluid().velocity(i)) / static_cast<double>(n);
            for (std::size_t i = 0; i < v.ground.positions.size(); ++i) {
                if (v.nearest(v.ground.positions[i]).second < 0.1 * v.cell && run.flow()[i] > 0) ++out.touching;
            }
            return out;
        };
        run_of const smooth = of(0);
        run_of const rough = of(0.25);
        CAPTURE(smooth.speed, smooth.touching, rough.speed, rough.touching, v.course.size());
        CHECK(rough.speed < 0.8 * smooth.speed);
        CHECK(rough.touching > smooth.touching);
        CHECK(rough.touching > 0.9 * static_cast<double>(v.course.size()));
    });
}

TEST_CASE("drops led down a real valley keep to its channel and wear it", "[slow]") {
    in_valley(GENERATE(ridge, alps), 45, [](valley const& v) {
        hydraulic_run run(v.ground, inflow{}.drops(v), shear_of(0.02), {.step_divisor = 50});
        run.run(300);
        check_stream(v, run);
        double all = 0;
        double channel = 0;
        for (std::size_t i = 0; i < v.ground.positions.size(); ++i) {
            all += static_cast<double>(run.flow()[i]);
            if (v.nearest(v.ground.positions[i]).second < 3 * v.cell) channel += static_cast<double>(run.flow()[i]);
        }
        CHECK(channel > 0.7 * all);
    });
}

TEST_CASE("a soft layer in the bank of a real valley is undercut", "[slow]") {
    struct layer {
        double low;
        double high;
        bool holds(vec3 const& p) const { return p[2] > low && p[2] < high; }
        double operator()(vec3 const& p) const { return holds(p) ? 0.8 : 0.03; }
    };
    in_valley(GENERATE(ridge, alps), 25, [](valley const& v) {
        vec3 const bend = v.course[v.bend];
        layer const soft{bend[2] - 0.3 * v.cell, bend[2] + 1.5 * v.cell};
        inflow const in{.fine = 0.3, .particles = 1600};
        hydraulic_run run(v.ground, in.stream(v), partheniades_erosion{.coefficient = soft, .critical = 1},
                          {.step_divisor = 50, .refine_length = 0.5 * v.cell, .check_every = 2});
        run.run(220);
        CHECK(run.balanced());
        CHECK(run.report().vertices_added > 100);
        triangle_surface const& s = run.surface();
        CHECK(self_intersections(s.positions, s.triangles).empty());
        // Around the bend, by where the layer was: vertices of the input keep their numbers.
        std::array<double, 2> wear{};
        std::array<double, 2> contacts{};
        for (std::size_t i = 0; i < v.ground.positions.size(); ++i) {
            vec3 const& p = v.ground.positions[i];
            if (length(vec3{p - bend}) > 5 * v.cell) continue;
            wear[soft.holds(p) ? 0 : 1] += run.wear()[i];
            contacts[soft.holds(p) ? 0 : 1] += static_cast<double>(run.flow()[i]);
        }
        CAPTURE(wear[0], wear[1], contacts[0], contacts[1]);
        CHECK(wear[0] * contacts[1] > 2.5 * wear[1] * contacts[0]);
        // Heights over a grid have no overhang; the rock over the layer has.
        std::size_t over = 0;
        std::size_t there = 0;
        for (auto const& t : s.triangles) {
            vec3 const a = s.positions[t[0]];
            vec3 const n = cross(vec3{s.positions[t[1]] - a}, vec3{s.positions[t[2]] - a});
            if (n[2] >= 0) continue;
            ++over;
            there += a[2] > soft.low - 0.5 * v.cell && a[2] < soft.high + 0.5 * v.cell ? 1U : 0U;
        }
        CAPTURE(over);
        CHECK(there >= 5);
        CHECK(static_cast<double>(there) > 0.7 * static_cast<double>(over));
    });
}
