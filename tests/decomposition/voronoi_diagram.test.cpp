#include "support/code_of.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/core/sum.hpp>
#include <tafoni/decomposition/voronoi_diagram.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace tafoni;
using tafoni_test::code_of;
using points = std::vector<vec3>;

box3 box(vec3 const& lo, vec3 const& hi) {
    box3 b;
    b.lo = lo;
    b.hi = hi;
    return b;
}
box3 const unit = box(vec3{0, 0, 0}, vec3{1, 1, 1});

voronoi_diagram diagram(points const& p, box3 const& b = unit, voronoi_options const& o = {}) {
    return make_voronoi_diagram(b, std::span<vec3 const>(p), o);
}

vec3 in_box(stream& random, double lo, double hi) {
    double const x = random.uniform(lo, hi);
    double const y = random.uniform(lo, hi);
    double const z = random.uniform(lo, hi);
    return vec3{x, y, z};
}

points uniform(std::size_t n, std::uint64_t seed = 1) {
    stream random(seed, stage::user, 0);
    points p;
    while (p.size() < n) p.push_back(in_box(random, 0, 1));
    return p;
}

// A lattice with the given points in each of m^3 cubes, moved by up to `jitter`.
points lattice(int m, points const& motif, double jitter = 0) {
    stream random(2, stage::user, 0);
    points p;
    for (int x = 0; x < m; ++x) {
        for (int y = 0; y < m; ++y) {
            for (int z = 0; z < m; ++z) {
                for (auto const& q : motif) {
                    vec3 const j = in_box(random, -jitter, jitter);
                    p.push_back(vec3{(x + q[0]) / m + j[0], (y + q[1]) / m + j[1], (z + q[2]) / m + j[2]});
                }
            }
        }
    }
    return p;
}
points const cubic{vec3{0.5, 0.5, 0.5}};
points const body_centred{vec3{0.25, 0.25, 0.25}, vec3{0.75, 0.75, 0.75}};
points const face_centred{vec3{0.25, 0.25, 0.25}, vec3{0.75, 0.75, 0.25}, vec3{0.75, 0.25, 0.75}, vec3{0.25, 0.75, 0.75}};

points hexagonal(int m) {
    points p;
    double const row = std::sqrt(0.75);
    for (int x = 0; x < m; ++x) {
        for (int y = 0; y < m; ++y) {
            for (int z = 0; z < m; ++z) {
                p.push_back(vec3{(x + 0.25 + 0.5 * (y % 2)) / m, (y + 0.5) * row / m, (z + 0.5) / m});
            }
        }
    }
    return p;
}

points sphere(std::size_t n) {
    stream random(3, stage::user, 0);
    points p{vec3{0.5, 0.5, 0.5}};
    while (p.size() <= n) {
        vec3 const u = random.unit_vector();
        p.push_back(vec3{0.5 + 0.25 * u[0], 0.5 + 0.25 * u[1], 0.5 + 0.25 * u[2]});
    }
    return p;
}

points flat(std::size_t n, int axes) {
    stream random(4, stage::user, 0);
    points p;
    while (p.size() < n) {
        vec3 q = in_box(random, 0, 1);
        for (int a = axes; a < 3; ++a) q[a] = 0.5;
        p.push_back(q);
    }
    return p;
}

points dense(std::size_t n, double share, double size) {
    stream random(5, stage::user, 0);
    points p;
    for (std::size_t k = 0; k < n; ++k) {
        bool const in = static_cast<double>(k) < share * static_cast<double>(n);
        p.push_back(in ? in_box(random, 0.3, 0.3 + size) : in_box(random, 0, 1));
    }
    std::sort(p.begin(), p.end(), lexicographically_less);
    p.erase(std::unique(p.begin(), p.end()), p.end());
    return p;
}

double volume_sum(voronoi_diagram const& d) {
    return pairwise_sum(0, d.cell_count(), [&d](std::size_t c) { return d.cell_volume(c); });
}
double box_volume(voronoi_diagram const& d) {
    vec3 const lo = lattice_frame::to_double(d.box_lo);
    vec3 const hi = lattice_frame::to_double(d.box_hi);
    return (hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]);
}

// Everything that can be said of a diagram without knowing how it was made; empty when all holds.
std::string broken_law(voronoi_diagram const& d) {
    auto const n = static_cast<std::uint32_t>(d.cell_count());
    double const size = std::cbrt(box_volume(d));
    if (std::fabs(volume_sum(d) / box_volume(d) - 1) > 1e-9) return "volumes do not sum up to the box";
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> faces;
    for (std::uint32_t c = 0; c < n; ++c) {
        std::set<std::uint32_t> vertices;
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        vec3 closure{0, 0, 0};
        std::uint32_t before = 0;
        for (std::uint32_t f = d.face_begin[c]; f < d.face_begin[c + 1]; ++f) {
            std::uint32_t const other = d.neighbour[f];
            if (other == c || other >= n + 6) return "a neighbour is no other cell and no wall";
            if (f > d.face_begin[c] && other <= before) return "neighbours are not ascending";
            before = other;
            auto const loop = d.corners_of(f);
            if (loop.size() < 3) return "a face has fewer than three corners";
            if (*std::min_element(loop.begin(), loop.end()) != loop[0]) return "the lowest corner is not the first";
            faces[{c, other}].assign(loop.begin(), loop.end());
            vec3 const area = d.face_area(f);
            for (int a = 0; a < 3; ++a) closure[a] += area[a];
            for (std::size_t k = 0; k < loop.size(); ++k) {
                std::uint32_t const v = loop[k];
                vertices.insert(v);
                if (!edges.insert({v, loop[(k + 1) % loop.size()]}).second) return "an edge occurs twice";
                auto const& key = d.keys[v];
                if (std::find(key.begin(), key.end(), c) == key.end()) return "a corner's key misses the cell";
                if (std::find(key.begin(), key.end(), other) == key.end()) return "a corner's key misses the neighbour";
                if (other < n) {
                    // Equally far from both sites, relative to the box.
                    vec3 const p = d.vertices[v];
                    vec3 const s = lattice_frame::to_double(d.sites[c]);
                    vec3 const t = lattice_frame::to_double(d.sites[other]);
                    double const gap = length(vec3{p[0] - s[0], p[1] - s[1], p[2] - s[2]}) -
                                       length(vec3{p[0] - t[0], p[1] - t[1], p[2] - t[2]});
                    if (std::fabs(gap) > 1e-13 * size) return "a corner is off the bisector by " + std::to_string(gap / size * 1e15) + "e-15";
                } else {
                    auto const w = other - n;
                    auto const at = w % 2 != 0 ? d.box_hi[w / 2] : d.box_lo[w / 2];
                    if (d.vertices[v][w / 2] != static_cast<double>(at)) return "a corner is off its wall";
                }
            }
        }
        for (auto const& e : edges) {
            if (edges.count({e.second, e.first}) == 0) return "a cell is not closed";
        }
        std::size_t const face_count = d.face_begin[c + 1] - d.face_begin[c];
        if (vertices.size() + face_count != edges.size() / 2 + 2) return "the Euler characteristic of a cell is not 2";
        if (length(closure) > 1e-13 * size * size) return "face areas of a cell do not cancel";
        if (!(d.cell_volume(c) > -1e-15 * size * size * size)) return "a volume is negative";
    }
    for (auto const& [pair, loop] : faces) {
        if (pair.second >= n) continue;
        auto const twin = faces.find({pair.second, pair.first});
        if (twin == faces.end()) return "a face has one side only";
        auto back = twin->second;
        std::reverse(back.begin() + 1, back.end());
        if (back != loop) return "the two sides of a face differ";
    }
    for (std::size_t v = 0; v < d.keys.size(); ++v) {
        auto const& k = d.keys[v];
        if (!(k[0] < k[1] && k[1] < k[2] && k[2] < k[3] && k[0] < n)) return "a key is not four ascending ids";
        if (v > 0 && !(d.keys[v - 1] < k)) return "keys are not ascending";
        if (!is_finite(d.vertices[v])) return "a vertex is not finite";
    }
    return {};
}

template <class T>
bool same_bytes(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}
bool same_geometry(voronoi_diagram const& a, voronoi_diagram const& b) {
    return a.sites == b.sites && a.face_begin == b.face_begin && a.neighbour == b.neighbour &&
           a.corner_begin == b.corner_begin && a.corners == b.corners && a.keys == b.keys &&
           same_bytes(a.vertices, b.vertices);
}

// Blocks on threads of their own, strided.
struct striped_executor {
    std::size_t threads;
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        std::vector<std::thread> pool;
        for (std::size_t t = 0; t < threads; ++t) {
            pool.emplace_back([&, t] {
                for (std::size_t b = t * grain; b < n; b += threads * grain) f(b, std::min(n, b + grain));
            });
        }
        for (auto& t : pool) t.join();
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return threads; }
};

}  // namespace

TEST_CASE("a Voronoi diagram is a closed, two-sided complex that fills the box, whatever the sites") {
    struct named {
        char const* name;
        points sites;
    };
    std::vector<named> const cases{
        {"one", {vec3{0.2, 0.3, 0.4}}},
        {"two", {vec3{0.2, 0.3, 0.4}, vec3{0.2, 0.3, 0.6}}},
        {"corners of the box", lattice(2, {vec3{0, 0, 0}})},
        {"sites on walls", {vec3{0, 0, 0}, vec3{1, 1, 1}, vec3{0, 0.5, 1}, vec3{0.5, 0.5, 0}, vec3{1, 0, 0}}},
        {"uniform", uniform(3000)},
        {"cubic 8", lattice(8, cubic)},
        {"cubic 11", lattice(11, cubic)},
        {"cubic 8, jitter 1e-9", lattice(8, cubic, 1e-9)},
        {"cubic 8, jitter 1e-12", lattice(8, cubic, 1e-12)},
        {"cubic 8, jitter 1e-14", lattice(8, cubic, 1e-14)},
        {"cubic 9, jitter 1e-16", lattice(9, cubic, 1e-16)},
        {"body-centred", lattice(6, body_centred)},
        {"face-centred", lattice(6, face_centred)},
        {"face-centred 5", lattice(5, face_centred)},
        {"hexagonal prisms", hexagonal(9)},
        {"sphere with a centre", sphere(600)},
        {"coplanar", flat(500, 2)},
        {"collinear", flat(500, 1)},
        {"90 % in 1 %", dense(2000, 0.9, 0.2154)},
        {"cluster of 1e-12", dense(500, 0.9, 1e-12)},
        {"cluster of 1e-15", dense(500, 0.9, 1e-15)},
        {"all in a cluster of 1e-9", dense(500, 1, 1e-9)},
    };
    for (auto const& c : cases) {
        INFO(c.name);
        // The smallest clusters are nothing but ties and coincidences on the lattice.
        auto const d = diagram(c.sites, unit, {.duplicates = duplicate_sites::merge});
        CHECK(broken_law(d) == "");
    }
}

TEST_CASE("each cell of a cubic lattice has its share of the volume and six neighbours of positive area") {
    for (int m : {4, 7, 12}) {
        auto const d = diagram(lattice(m, cubic));
        double const volume = box_volume(d) / (m * m * m);
        double const side2 = std::pow(volume, 2.0 / 3.0);
        for (std::size_t c = 0; c < d.cell_count(); ++c) {
            REQUIRE(std::fabs(d.cell_volume(c) / volume - 1) < 1e-12);
            int large = 0;
            for (std::size_t f = d.face_begin[c]; f < d.face_begin[c + 1]; ++f) {
                double const a = length(d.face_area(f)) / side2;
                REQUIRE((a < 1e-12 || std::fabs(a - 1) < 1e-12));
                large += a > 0.5;
            }
            REQUIRE(large == 6);
        }
    }
}

TEST_CASE("inner cells of the body-centred and face-centred lattices are the solids of the textbook") {
    auto const large_faces = [](points const& p, vec3 const& at) {
        auto const d = diagram(p);
        int count = 0;
        for (std::size_t c = 0; c < d.cell_count(); ++c) {
            vec3 const s = d.frame.to_user(d.sites[c]);
            if (length(vec3{s[0] - at[0], s[1] - at[1], s[2] - at[2]}) > 1e-9) continue;
            for (std::size_t f = d.face_begin[c]; f < d.face_begin[c + 1]; ++f) {
                count += length(d.face_area(f)) > 1e-9 * std::pow(box_volume(d), 2.0 / 3.0);
            }
        }
        return count;
    };
    REQUIRE(large_faces(lattice(5, body_centred), vec3{2.25 / 5, 2.25 / 5, 2.25 / 5}) == 14);
    REQUIRE(large_faces(lattice(5, face_centred), vec3{2.25 / 5, 2.25 / 5, 2.25 / 5}) == 12);
    REQUIRE(large_faces(hexagonal(7), vec3{3.75 / 7, 3.5 * std::sqrt(0.75) / 7, 3.5 / 7}) == 8);
}

TEST_CASE("a random point lies in the cell of its nearest site") {
    for (auto const& sites : {uniform(400), dense(400, 0.9, 0.2), sphere(150)}) {
        auto const d = diagram(sites);
        stream random(9, stage::user, 0);
        for (int trial = 0; trial < 3000; ++trial) {
            vec3 const q = lattice_frame::to_double(d.frame.to_lattice(in_box(random, 0, 1)));
            std::size_t nearest = 0;
            double best = INFINITY;
            for (std::size_t c = 0; c < d.cell_count(); ++c) {
                vec3 const s = lattice_frame::to_double(d.sites[c]);
                double const r = squared_length(vec3{q[0] - s[0], q[1] - s[1], q[2] - s[2]});
                if (r < best) {
                    best = r;
                    nearest = c;
                }
            }
            for (std::size_t f = d.face_begin[nearest]; f < d.face_begin[nearest + 1]; ++f) {
                vec3 const n = normalized(d.face_area(f));
                vec3 const o = d.vertices[d.corners_of(f)[0]];
                REQUIRE(dot(n, vec3{q[0] - o[0], q[1] - o[1], q[2] - o[2]}) < 1e-9 * static_cast<double>(lattice_frame::limit));
            }
        }
    }
}

TEST_CASE("permuting the sites permutes ids only") {
    for (auto p : {uniform(500), lattice(7, cubic), hexagonal(6)}) {
        auto const a = diagram(p);
        stream random(11, stage::user, 0);
        points q = p;
        for (std::size_t k = q.size() - 1; k > 0; --k) std::swap(q[k], q[random.index_below(k + 1)]);
        auto const b = diagram(q);
        REQUIRE(same_geometry(a, b));
        for (std::size_t c = 0; c < a.cell_count(); ++c) {
            REQUIRE(p[a.input_of[c]] == q[b.input_of[c]]);
            REQUIRE(b.cell_of_input[b.input_of[c]] == c);
        }
    }
}

TEST_CASE("shifts that doubles hold and powers of two change no bit of the lattice geometry") {
    points p = uniform(300);
    for (auto& q : p) {
        for (int a = 0; a < 3; ++a) q[a] = std::floor(q[a] * 0x1p20) * 0x1p-20;
    }
    auto const d = diagram(p);
    for (double scale : {0x1p-300, 0x1p-3, 0x1p7, 0x1p300}) {
        for (double shift : {0.0, -0.5, 1024.0}) {
            auto const move = [&](vec3 const& q) {
                return vec3{(q[0] + shift) * scale, (q[1] + shift) * scale, (q[2] + shift) * scale};
            };
            points moved;
            for (auto const& q : p) moved.push_back(move(q));
            REQUIRE(same_geometry(d, diagram(moved, box(move(unit.lo), move(unit.hi)))));
        }
    }
}

TEST_CASE("the number of threads changes no byte") {
    auto const p = dense(4000, 0.5, 0.2);
    auto const a = diagram(p);
    for (std::size_t threads : {1U, 2U, 7U}) {
        auto const b = make_voronoi_diagram(unit, std::span<vec3 const>(p), {}, striped_executor{threads});
        REQUIRE(same_geometry(a, b));
    }
}

TEST_CASE("the same bits come from every compiler") {
    auto const d = diagram(lattice(5, cubic, 0.04));
    std::uint64_t hash = 14695981039346656037ULL;
    auto const mix = [&hash](void const* bytes, std::size_t count) {
        auto const* b = static_cast<unsigned char const*>(bytes);
        for (std::size_t k = 0; k < count; ++k) hash = (hash ^ b[k]) * 1099511628211ULL;
    };
    mix(d.vertices.data(), d.vertices.size() * sizeof(vec3));
    mix(d.corners.data(), d.corners.size() * sizeof(std::uint32_t));
    mix(d.neighbour.data(), d.neighbour.size() * sizeof(std::uint32_t));
    REQUIRE(hash == 15621269845892094750ULL);
}

TEST_CASE("duplicate sites are refused with both names, or merged and counted") {
    points p = uniform(50);
    p.push_back(p[7]);
    p.push_back(p[7]);
    p.push_back(p[21]);
    try {
        (void)diagram(p);
        FAIL("no error");
    } catch (invalid_input const& e) {
        REQUIRE(e.code() == errc::duplicate_sites);
        std::string const what = e.what();
        bool const seven = what.find("sites 7 and 50") != std::string::npos;
        bool const other = what.find("sites 21 and 52") != std::string::npos;
        REQUIRE((seven || other));
    }
    auto const d = diagram(p, unit, {.duplicates = duplicate_sites::merge});
    REQUIRE(d.cell_count() == 50);
    REQUIRE(d.merged_count() == 3);
    REQUIRE(d.cell_of_input[50] == d.cell_of_input[7]);
    REQUIRE(d.cell_of_input[51] == d.cell_of_input[7]);
    REQUIRE(d.cell_of_input[52] == d.cell_of_input[21]);
    REQUIRE(d.input_of[d.cell_of_input[7]] == 7);
    points const first(p.begin(), p.begin() + 50);
    REQUIRE(same_geometry(d, diagram(first)));
}

TEST_CASE("bad sites and boxes get an error that names them") {
    points const p{vec3{0.5, 0.5, 0.5}, vec3{0.25, 0.5, 0.5}};
    REQUIRE(code_of([] { (void)diagram({}); }) == errc::no_sites);
    REQUIRE(code_of([] { (void)diagram({vec3{0.5, 0.5, 1.5}}); }) == errc::site_outside);
    REQUIRE(code_of([] { (void)diagram({vec3{0.5, 0.5, NAN}}); }) == errc::non_finite_site);
    REQUIRE(code_of([] { (void)diagram({vec3{0.5, INFINITY, 0}}); }) == errc::non_finite_site);
    REQUIRE(code_of([&] { (void)diagram(p, box(vec3{1, 1, 1}, vec3{0, 0, 0})); }) == errc::bad_box);
    REQUIRE(code_of([&] { (void)diagram({vec3{0, 0, 0}}, box(vec3{0, 0, 0}, vec3{1, 1, 0})); }) == errc::bad_box);
    REQUIRE(code_of([&] { (void)diagram(p, box(vec3{-INFINITY, 0, 0}, vec3{1, 1, 1})); }) == errc::bad_box);
    try {
        (void)diagram({vec3{0.5, 0.5, 0.5}, vec3{0.5, 0.5, 0.5}, vec3{0, -1, 0}});
        FAIL("no error");
    } catch (invalid_input const& e) {
        REQUIRE(e.code() == errc::site_outside);
        REQUIRE(e.place().index == 2);
        REQUIRE(e.place().kind == entity::site);
    }
}

TEST_CASE("an observer sees progress and can cancel a diagram at every tick") {
    auto const p = uniform(2000);
    std::vector<double> seen;
    run_context context;
    context.on_progress = [&](progress_event const& e) {
        seen.push_back(e.fraction);
        return step_control::proceed;
    };
    auto const whole = make_voronoi_diagram(unit, std::span<vec3 const>(p), {}, inline_executor{}, context);
    REQUIRE(seen.front() == 0);
    REQUIRE(seen.back() == 1);
    REQUIRE(std::is_sorted(seen.begin(), seen.end()));
    for (std::size_t stop = 0; stop < seen.size(); ++stop) {
        std::size_t tick = 0;
        context.on_progress = [&](progress_event const&) {
            return tick++ == stop ? step_control::stop : step_control::proceed;
        };
        REQUIRE_THROWS_AS(make_voronoi_diagram(unit, std::span<vec3 const>(p), {}, inline_executor{}, context), cancelled);
    }
    REQUIRE(same_geometry(whole, diagram(p)));
}

TEST_CASE("a cell with 1500 neighbours keeps all laws", "[slow]") {
    auto const d = diagram(sphere(1500));
    REQUIRE(broken_law(d) == "");
    std::uint32_t most = 0;
    for (std::size_t c = 0; c < d.cell_count(); ++c) most = std::max(most, d.face_begin[c + 1] - d.face_begin[c]);
    REQUIRE(most == 1500);
}

TEST_CASE("large uniform, dense and degenerate diagrams keep all laws", "[slow]") {
    CHECK(broken_law(diagram(uniform(40000))) == "");
    CHECK(broken_law(diagram(dense(40000, 0.9, 0.2154))) == "");
    CHECK(broken_law(diagram(lattice(30, cubic))) == "");
    CHECK(broken_law(diagram(lattice(30, cubic, 1e-14))) == "");
    CHECK(broken_law(diagram(flat(20000, 2))) == "");
    CHECK(broken_law(diagram(flat(20000, 1))) == "");
}
