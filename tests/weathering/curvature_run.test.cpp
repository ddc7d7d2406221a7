#include "support/curved_surfaces.hpp"
#include "support/test_data.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <catch2/catch.hpp>

#include <bit>
#include <limits>
#include <map>
#include <utility>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// n x n squares on each side of [0, 1]^3, cut into triangles.
triangle_surface cube(int n) {
    triangle_surface s;
    std::map<std::array<int, 3>, std::uint32_t> number;
    auto const at = [&](std::array<int, 3> const& q) {
        auto const [i, fresh] = number.try_emplace(q, static_cast<std::uint32_t>(s.positions.size()));
        if (fresh) s.positions.push_back(vec3{1.0 * q[0] / n, 1.0 * q[1] / n, 1.0 * q[2] / n});
        return i->second;
    };
    for (std::size_t d = 0; d < 3; ++d) {
        for (int side : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    auto const corner = [&](int a, int b) {
                        std::array<int, 3> q{};
                        q[d] = side;
                        q[(d + 1) % 3] = a;
                        q[(d + 2) % 3] = b;
                        return at(q);
                    };
                    std::uint32_t const a = corner(i, j);
                    std::uint32_t b = corner(i + 1, j);
                    std::uint32_t const c = corner(i + 1, j + 1);
                    std::uint32_t e = corner(i, j + 1);
                    if (side == 0) std::swap(b, e);
                    s.triangles.push_back({a, b, c});
                    s.triangles.push_back({a, c, e});
                }
            }
        }
    }
    return s;
}

struct roundness {
    double mean = 0;
    double deviation = 0;  ///< of the radius, over its mean
};
roundness round(triangle_surface const& s) {
    vec3 c{0, 0, 0};
    for (vec3 const& p : s.positions) c += p;
    c /= static_cast<double>(s.positions.size());
    double sum = 0;
    double square = 0;
    for (vec3 const& p : s.positions) {
        double const r = length(p - c);
        sum += r;
        square += r * r;
    }
    auto const n = static_cast<double>(s.positions.size());
    double const mean = sum / n;
    return {mean, std::sqrt(std::max(square / n - mean * mean, 0.0)) / mean};
}
double volume(triangle_surface const& s) {
    double six = 0;
    for (auto const& t : s.triangles) {
        six += dot(s.positions[t[0]], cross(s.positions[t[1]], s.positions[t[2]]));
    }
    return six / 6;
}
bool same_bits(triangle_surface const& a, triangle_surface const& b) {
    return a.triangles == b.triangles && a.positions.size() == b.positions.size() &&
           std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), [](vec3 const& p, vec3 const& q) {
               for (int d = 0; d < 3; ++d) {
                   if (std::bit_cast<std::uint64_t>(p[d]) != std::bit_cast<std::uint64_t>(q[d])) return false;
               }
               return true;
           });
}
/// Shortest over longest side, least over the triangles.
double worst_shape(triangle_surface const& s) {
    double worst = 1;
    for (auto const& t : s.triangles) {
        double low = std::numeric_limits<double>::max();
        double high = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            double const l = length(s.positions[t[k]] - s.positions[t[(k + 1) % 3]]);
            low = std::min(low, l);
            high = std::max(high, l);
        }
        worst = std::min(worst, low / high);
    }
    return worst;
}

}  // namespace

TEST_CASE("a cube of 20 x 20 squares a side becomes a sphere in 200 iterations", "[paper]") {
    triangle_surface const c = cube(20);
    curvature_run run(c);
    run.run(200);
    roundness const r = round(run.surface());
    CHECK(r.deviation < 0.05);  // the bar; 0.012 measured, the cube has 0.128
    CHECK(r.mean < 0.62);
    CHECK(r.mean > 0.3);
    CHECK(run.report().removed_volume == Approx(1 - volume(run.surface())).epsilon(1e-9));
}

TEST_CASE("the Laplacian keeps triangles in better shape than the normal does", "[paper]") {
    triangle_surface const c = cube(12);
    curvature_run even(c, curvature_weathering{}, {.topology = mesh_topology::keep});
    curvature_run uneven(c, curvature_weathering{.direction = inward_normal{}}, {.topology = mesh_topology::keep});
    curvature_run between(c, curvature_weathering{.direction = blended_direction{}}, {.topology = mesh_topology::keep});
    even.run(100);
    uneven.run(100);
    between.run(100);
    CHECK(worst_shape(even.surface()) > 1.2 * worst_shape(uneven.surface()));
    CHECK(worst_shape(between.surface()) > worst_shape(uneven.surface()));
}

TEST_CASE("a larger power spares what is flat", "[paper]") {
    triangle_surface const c = cube(16);
    double before = -1;
    for (double const n : {1.0, 2.0, 3.0}) {
        curvature_run run(c, curvature_weathering{}, {.power = n});
        run.run(60);
        double const left = volume(run.surface());
        CHECK(left > before);
        before = left;
    }
    // What is nearly flat, the middle of an ellipsoid's broad side, wears by (H / H_max)^n of what its rim does.
    triangle_surface lens = triangles_of(icosphere(3));
    for (vec3& p : lens.positions) p[2] *= 0.5;
    std::vector<double> const h = estimate_curvature(lens);
    double const most = *std::max_element(h.begin(), h.end());
    for (double const n : {1.0, 2.0, 3.0}) {
        curvature_run run(lens, curvature_weathering{}, {.power = n, .topology = mesh_topology::keep});
        run.run(1);
        std::vector<double> const wear = run.wear();
        double const rim = *std::max_element(wear.begin(), wear.end());
        for (std::size_t v = 0; v < h.size(); ++v) REQUIRE(wear[v] / rim == Approx(std::pow(h[v] / most, n)).epsilon(1e-9));
    }
}

TEST_CASE("an iteration is equations 9.1 to 9.5, written out over sets of neighbours") {
    triangle_surface input = torus_surface(18, 12, 0.35).mesh;
    input.triangles.erase(input.triangles.begin() + 50, input.triangles.begin() + 58);  // a border
    // A cavity of small radius, so that the largest |H| is that of a hollow.
    triangle_surface const hole = triangles_of(icosphere(1));
    auto const first = static_cast<std::uint32_t>(input.positions.size());
    for (vec3 const& p : hole.positions) input.positions.push_back(vec3{0.2 * p[0] + 3, 0.2 * p[1], 0.2 * p[2]});
    for (auto const& t : hole.triangles) input.triangles.push_back({first + t[0], first + t[2], first + t[1]});
    std::map<std::array<std::uint32_t, 2>, int> sides;  // ascending ends -> triangles
    for (auto const& t : input.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++sides[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
    }
    struct rock {
        double operator()(vec3 const& p) const { return 1.5 + p[0]; }
    };
    for (double const n : {1.0, 2.5}) {
        for (bool const along_normals : {false, true}) {
            triangle_surface s = input;
            std::vector<double> way(s.positions.size(), 0.0);
            double const x = 7;
            for (int iteration = 0; iteration < 3; ++iteration) {
                std::vector<double> const h = estimate_curvature(s);
                double largest = 0;
                for (double const k : h) largest = std::max(largest, std::fabs(k));
                REQUIRE(largest > 1);
                REQUIRE(largest > *std::max_element(h.begin(), h.end()));
                double mean = 0;
                for (auto const& [e, faces] : sides) mean += length(s.positions[e[0]] - s.positions[e[1]]);
                mean /= static_cast<double>(sides.size());
                std::vector<vec3> laplacian(h.size(), vec3{0, 0, 0});
                for (std::size_t v = 0; v < h.size(); ++v) {
                    bool border = false;
                    for (auto const& [e, faces] : sides) border = border || ((e[0] == v || e[1] == v) && faces == 1);
                    double count = 0;
                    for (auto const& [e, faces] : sides) {
                        if ((e[0] != v && e[1] != v) || (border && faces != 1)) continue;
                        laplacian[v] += s.positions[e[0] == v ? e[1] : e[0]] - s.positions[v];
                        count += 1;
                    }
                    laplacian[v] /= count;
                }
                std::vector<vec3> normal(h.size());
                vertex_rings const rings(h.size(), s.triangles);
                vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
                for (std::size_t v = 0; v < h.size(); ++v) {
                    if (!(h[v] > 0)) continue;
                    double const d = std::min(std::pow(h[v] / largest, n) / rock{}(s.positions[v]), 1.0) * mean / x;
                    vec3 const step = along_normals ? vec3{-d * normal[v]} : vec3{d / length(laplacian[v]) * laplacian[v]};
                    s.positions[v] += step;
                    way[v] += length(step);
                }
            }
            auto const check = [&](auto const& process) {
                curvature_run run(input, process, {.power = n, .step_divisor = x, .topology = mesh_topology::keep});
                CHECK(run.run(3).iterations == 3);
                triangle_surface const out = run.surface();
                for (std::size_t v = 0; v < way.size(); ++v) {
                    REQUIRE(length(out.positions[v] - s.positions[v]) < 1e-10);
                    REQUIRE(run.wear()[v] == Approx(way[v]).margin(1e-10));
                }
            };
            if (along_normals) check(curvature_weathering{.direction = inward_normal{}, .durability = rock{}});
            else check(curvature_weathering{.durability = rock{}});
        }
    }
}

TEST_CASE("curvature within [-1, 1] is not scaled: gentle slopes wear gently") {
    // Of unit size inside; a cap of radius 4 bends by 1/4.
    curved_surface const cap = parametric(
        21, 21, false, false, 0,
        [](double u, double v) {
            double const x = 0.9 * (u - 0.5);
            double const y = 0.9 * (v - 0.5);
            return vec3{x, y, std::sqrt(16 - x * x - y * y)};
        },
        [](double, double) { return 0.25; });
    curvature_run run(cap.mesh, curvature_weathering{.direction = inward_normal{}}, {.step_divisor = 10});
    run.run(1);
    vertex_rings const rings(cap.mesh.positions.size(), cap.mesh.triangles);
    double edges = 0;
    double count = 0;
    for (std::size_t v = 0; v < cap.mesh.positions.size(); ++v) {
        for (auto const w : rings.neighbors(v)) {
            edges += length(cap.mesh.positions[w] - cap.mesh.positions[v]);
            count += 1;
        }
    }
    auto const wear = run.wear();
    for (std::size_t v = 0; v < wear.size(); ++v) {
        bool inside = !rings.is_border(v);
        for (auto const w : rings.neighbors(v)) inside = inside && !rings.is_border(w);
        if (inside) CHECK(wear[v] == Approx(0.25 * edges / count / 10).epsilon(1e-3));
    }
}

TEST_CASE("an open mesh keeps its outline") {
    triangle_surface const pipe = cylinder(40, 21, 0.2).mesh;  // its ends jitter along the axis
    triangle_surface tube = pipe;
    for (vec3& p : tube.positions) p[2] = std::min(std::max(p[2], 0.0), 2.0);
    for (std::uint32_t i = 0; i < 40; ++i) {
        tube.positions[i * 21][2] = 0;
        tube.positions[i * 21 + 20][2] = 2;
    }
    for (auto const topology : {mesh_topology::keep, mesh_topology::adapt}) {
        curvature_run run(tube, curvature_weathering{}, {.small_edge = 0.3, .topology = topology});
        run.run(60);
        triangle_surface const out = run.surface();
        vertex_rings const rings(out.positions.size(), out.triangles);
        std::size_t border = 0;
        for (std::size_t v = 0; v < out.positions.size(); ++v) {
            if (!rings.is_border(v)) continue;
            ++border;
            REQUIRE((out.positions[v][2] == 0 || out.positions[v][2] == 2));
            REQUIRE(out.positions[v][0] * out.positions[v][0] + out.positions[v][1] * out.positions[v][1] < 0.99);
        }
        CHECK(border > 40);
        CHECK(run.report().removed_volume > 0);
    }
}

TEST_CASE("hollows and planes are not touched") {
    // A bowl seen from inside bends towards its normal everywhere.
    triangle_surface bowl = sphere(3).mesh;
    for (auto& t : bowl.triangles) std::swap(t[1], t[2]);
    curvature_run run(bowl);
    curvature_report const r = run.run(5);
    CHECK(r.stopped == curvature_stop::worn_away);
    CHECK(r.iterations == 0);
    CHECK(same_bits(run.surface(), bowl));
}

TEST_CASE("no iterations change no bit, and n then m equal n + m") {
    triangle_surface s = torus_surface(40, 24, 0.3).mesh;
    for (vec3& p : s.positions) p = vec3{p[0] * 3.3 + 1e6, p[1] * 3.3 - 7, p[2] * 3.3};
    curvature_run none(s);
    none.run(0);
    CHECK(same_bits(none.surface(), s));
    curvature_run once(s);
    curvature_run twice(s);
    once.run(12);
    twice.run(5);
    twice.run(7);
    CHECK(same_bits(once.surface(), twice.surface()));
}

TEST_CASE("shifts and powers of two of the model commute with weathering, any scale works") {
    triangle_surface const s = torus_surface(30, 20, 0.3).mesh;
    curvature_run small(s);
    small.run(10);
    for (double const scale : {0x1p-90, 4.0, 0x1p90}) {
        triangle_surface t = s;
        for (vec3& p : t.positions) p = vec3{p[0] * scale, p[1] * scale, p[2] * scale};
        curvature_run large(t);
        large.run(10);
        triangle_surface back = large.surface();
        for (vec3& p : back.positions) p = vec3{p[0] / scale, p[1] / scale, p[2] / scale};
        CHECK(same_bits(back, small.surface()));
    }
}

TEST_CASE("threads change no bit of a weathered mesh", "[threads]") {
    triangle_surface const s = torus_surface(60, 40, 0.4).mesh;
    auto const weather = [&](auto const& threads) {
        curvature_run run(s, curvature_weathering{.direction = blended_direction{}});
        run.run(6, {}, threads);
        return run.surface();
    };
    triangle_surface const one = weather(inline_executor{});
    for (std::size_t n : {2U, 3U, 7U}) CHECK(same_bits(one, weather(thread_pool(n))));
}

TEST_CASE("hard rock wears less in proportion, a field decides where") {
    triangle_surface const s = sphere(4).mesh;
    curvature_run soft(s, curvature_weathering{.durability = constant_field{1}});
    curvature_run hard(s, curvature_weathering{.durability = constant_field{4}});
    soft.run(1);
    hard.run(1);
    double const a = 1 - round(soft.surface()).mean;
    double const b = 1 - round(hard.surface()).mean;
    CHECK(a / b == Approx(4).epsilon(0.02));
    struct upper_half {
        double operator()(vec3 const& p) const { return p[2] > 0 ? 1e9 : 1.0; }
    };
    curvature_run half(s, curvature_weathering{.durability = upper_half{}});
    half.run(4);
    triangle_surface const left = half.surface();
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        double const moved = length(left.positions[v] - s.positions[v]);
        CHECK((s.positions[v][2] > 0 ? moved < 1e-8 : moved > 1e-3));
    }
}

TEST_CASE("a sphere shrinks by the step that equation 9.5 gives") {
    // H is the same everywhere, so every vertex moves by e / x towards the centre, but for the triangles' own bias.
    triangle_surface const s = sphere(4).mesh;
    curvature_run run(s, curvature_weathering{.direction = inward_normal{}}, {.step_divisor = 20});
    double const step = s.mean_edge_length() / 20;
    run.run(1);
    for (vec3 const& p : run.surface().positions) CHECK(1 - length(p) == Approx(step).epsilon(1e-6));
    for (double const w : run.wear()) CHECK(w == Approx(step).epsilon(1e-6));
}

TEST_CASE("keep-topology keeps numbers, adapt reports where every vertex went") {
    triangle_surface s = cube(10);
    for (vec3& p : s.positions) p[0] *= 6;  // thin sides become short edges as the bar rounds
    curvature_run kept(s, curvature_weathering{}, {.topology = mesh_topology::keep});
    kept.run(150);
    CHECK(kept.surface().triangles == s.triangles);
    curvature_run adapted(s, curvature_weathering{}, {.small_edge = 0.4});
    std::vector<double> before(s.positions.size(), 0.0);
    for (int k = 0; k < 75; ++k) {
        adapted.run(2);
        std::vector<double> const wear = adapted.wear();
        for (std::size_t v = 0; v < before.size(); ++v) {  // of two ends that become one the longer way
            double const now = wear[adapted.new_vertex()[v].value];
            REQUIRE(now >= before[v]);
            before[v] = now;
        }
    }
    CHECK(adapted.report().edges_collapsed > 0);
    triangle_surface const now = adapted.surface();
    REQUIRE(adapted.new_vertex().size() == s.positions.size());
    for (vertex_index const v : adapted.new_vertex()) CHECK(v.value < now.positions.size());
    CHECK(adapted.wear().size() == now.positions.size());
}

TEST_CASE("triangles that cut each other from the start are none of the run's business") {
    triangle_surface s = cube(6);
    s.positions.insert(s.positions.end(), s.positions.begin(), s.positions.end());
    std::size_t const n = s.positions.size() / 2;
    std::size_t const faces = s.triangles.size();
    for (std::size_t v = n; v < 2 * n; ++v) s.positions[v] += vec3{0.5, 0.03, 0.01};  // overlaps from the start
    for (std::size_t f = 0; f < faces; ++f) {
        auto t = s.triangles[f];
        for (auto& c : t) c += static_cast<std::uint32_t>(n);
        s.triangles.push_back(t);
    }
    curvature_run run(s, curvature_weathering{}, {.check_every = 1, .retries = 3});
    curvature_report const r = run.run(10);
    CHECK(r.stopped == curvature_stop::finished);
    CHECK(r.retries == 0);
    CHECK(r.iterations == 10);
}

TEST_CASE("an observer stops a run after a whole iteration, and it goes on to the same bits") {
    triangle_surface const s = torus_surface(30, 20, 0.3).mesh;
    curvature_run whole(s);
    whole.run(6);
    for (int k = 0; k < 6; ++k) {
        curvature_run run(s);
        int ticks = 0;
        run_context context;
        context.on_progress = [&](progress_event const&) { return ticks++ == k ? step_control::stop : step_control::proceed; };
        CHECK(run.run(6, context).stopped == curvature_stop::observer);
        CHECK(run.report().iterations == static_cast<std::uint64_t>(k));
        run.run(6 - static_cast<std::uint64_t>(k));
        CHECK(same_bits(run.surface(), whole.surface()));
    }
}

TEST_CASE("curvature is that of the surface at any time, asks nothing of a run and changes nothing in it") {
    triangle_surface s = torus_surface(24, 12, 0.3).mesh;
    for (vec3& p : s.positions) p[2] *= 0.25;
    curvature_run run(s, curvature_weathering{}, {.small_edge = 0.35});
    curvature_run left_alone = run;
    for (int k = 0; k < 6; ++k) {
        curvature_run<> const& seen = run;
        std::vector<double> const once = seen.curvature();
        std::vector<double> const again = seen.curvature(thread_pool(2));
        std::vector<double> const wanted = estimate_curvature(run.surface());
        REQUIRE(once.size() == wanted.size());
        CHECK(once == again);
        for (std::size_t v = 0; v < wanted.size(); ++v) REQUIRE(once[v] == Approx(wanted[v]).epsilon(1e-9).margin(1e-9));
        run.run(1);
        left_alone.run(1);
        REQUIRE(run.checkpoint() == left_alone.checkpoint());
    }
    CHECK(run.report().edges_collapsed > 0);
    // Where the rings are to be found anew.
    curvature_run resumed(s, curvature_weathering{}, {.small_edge = 0.35});
    resumed.resume(run.checkpoint());
    CHECK(std::as_const(resumed).curvature() == run.curvature());
}

TEST_CASE("what a run keeps from iteration to iteration is what a run that is resumed finds anew, where edges collapse too") {
    triangle_surface s = torus_surface(24, 12, 0.3).mesh;
    for (vec3& p : s.positions) p[2] *= 0.25;
    s.positions.push_back(vec3{2, 2, 2});  // a lone vertex, and a triangle that names one twice
    s.triangles.push_back({3, 3, 7});
    curvature_options const options{.small_edge = 0.2};
    for (bool const open : {false, true}) {
        if (open) s.triangles.erase(s.triangles.begin() + 100, s.triangles.begin() + 140);
        curvature_run run(s, curvature_weathering{}, options);
        std::uint64_t collapsing = 0;
        for (int k = 0; k < 20; ++k) {
            std::uint64_t const before = run.report().edges_collapsed;
            curvature_run resumed(s, curvature_weathering{}, options);
            resumed.resume(run.checkpoint());
            run.run(1);
            resumed.run(1);
            REQUIRE(resumed.checkpoint() == run.checkpoint());
            collapsing += run.report().edges_collapsed > before ? 1U : 0U;
        }
        CHECK(collapsing >= 3);
        CHECK(collapsing < 20);
    }
}

TEST_CASE("every option out of range is refused by name") {
    triangle_surface const s = cube(2);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    auto const refused = [&](curvature_options const& o, char const* name) {
        CHECK_THROWS_WITH(curvature_run(s, curvature_weathering{}, o), Catch::Contains(name));
    };
    for (double const bad : {nan, -1.0, 0.5, 1e9}) refused({.power = bad}, "power");
    for (double const bad : {nan, -1.0, 0.5}) refused({.step_divisor = bad}, "step_divisor");
    for (double const bad : {nan, -0.1, 0.6}) refused({.small_edge = bad}, "small_edge");
    refused({.retries = 99}, "retries");
}

TEST_CASE("odd meshes weather without a number that is not one") {
    triangle_surface s = torus_surface(16, 10, 0.2).mesh;
    s.positions.push_back(vec3{5, 5, 5});  // a lone vertex
    s.positions.push_back(s.positions[3]);
    s.triangles.push_back({3, static_cast<std::uint32_t>(s.positions.size() - 1), 4});  // no area
    s.triangles.push_back({1, 1, 2});
    for (auto const topology : {mesh_topology::keep, mesh_topology::adapt}) {
        curvature_run run(s, curvature_weathering{.direction = blended_direction{}}, {.topology = topology});
        run.run(10);
        for (vec3 const& p : run.surface().positions) REQUIRE(is_finite(p));
    }
    curvature_run empty(triangle_surface{});
    CHECK(empty.run(3).stopped == curvature_stop::worn_away);
}

TEST_CASE("thin fingers survive 400 iterations with a power of 5", "[slow][paper]") {
    auto const path = find("meshes/hand_closed_8k.obj");
    if (path.empty()) {
        WARN("skipped: meshes/hand_closed_8k.obj is not here");
        return;
    }
    triangle_surface const hand = triangles_of(read_mesh(path).mesh);
    curvature_run run(hand, curvature_weathering{}, {.power = 5, .check_every = 50});
    curvature_report const r = run.run(400);
    CHECK(r.iterations == 400);
    CHECK(r.stopped == curvature_stop::finished);
    CHECK(self_intersections(run.surface().positions, run.surface().triangles).empty());
    CHECK(r.removed_volume > 0);
    auto const share_of_reach = [&](triangle_surface const& s) {  // of the hand's box, least over the axes
        box3 before;
        box3 after;
        for (vec3 const& p : hand.positions) before.include(p);
        for (vec3 const& p : s.positions) after.include(p);
        double least = 1;
        for (int d = 0; d < 3; ++d) least = std::min(least, after.extent()[d] / before.extent()[d]);
        return least;
    };
    CHECK(share_of_reach(run.surface()) > 0.96);  // 0.973 measured
    CHECK(volume(run.surface()) > 0.98 * volume(hand));
    curvature_run blunt(hand);  // the same with a power of 1: the fingers go
    blunt.run(400);
    CHECK(share_of_reach(blunt.surface()) < 0.8);
    CHECK(blunt.report().edges_collapsed > 1000);
}

TEST_CASE("a direction is told of the Laplacian in the user's unit, and as printed goes by it") {
    struct spy {
        double* worst;
        triangle_surface const* mesh;
        vertex_rings const* rings;
        vec3 direction(wear_point const& at) const {
            std::size_t v = 0;
            for (std::size_t w = 0; w < mesh->positions.size(); ++w) {
                if (squared_length(mesh->positions[w] - at.position) < squared_length(mesh->positions[v] - at.position)) v = w;
            }
            vec3 mean{0, 0, 0};
            for (std::uint32_t const w : rings->neighbors(v)) mean += mesh->positions[w] - mesh->positions[v];
            mean /= static_cast<double>(rings->neighbors(v).size());
            *worst = std::max(*worst, length(at.laplacian - mean) / length(mean));
            return normalized(at.laplacian);
        }
    };
    for (double const unit : {1.0, 1000.0, 0.001}) {
        triangle_surface s = sphere(2).mesh;
        for (vec3& p : s.positions) p = unit * p;
        vertex_rings const rings(s.positions.size(), s.triangles);
        double worst = -1;
        curvature_run<curvature_weathering<tensor_fit, spy>> seen(s, {.direction = {&worst, &s, &rings}});
        seen.run(1);
        CHECK(worst >= 0);
        CHECK(worst < 1e-9);
        curvature_run unit_long(s, curvature_weathering{}, {.topology = mesh_topology::keep});
        curvature_run printed(s, curvature_weathering{.direction = laplacian_direction{.scale = laplacian_length::as_printed}},
                              {.topology = mesh_topology::keep});
        unit_long.run(1);
        printed.run(1);
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            vec3 mean{0, 0, 0};
            for (std::uint32_t const w : rings.neighbors(v)) mean += s.positions[w] - s.positions[v];
            mean /= static_cast<double>(rings.neighbors(v).size());
            CHECK(printed.wear()[v] == Approx(length(mean) * unit_long.wear()[v]).epsilon(1e-9));
        }
    }
}
