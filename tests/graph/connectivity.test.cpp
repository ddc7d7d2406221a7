#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/connectivity.hpp>

#include <map>
#include <numeric>
#include <set>

using namespace tafoni;

namespace {

/// A cells graph of nothing but edges; multi-edges and self links allowed.
struct plain_network {
    std::vector<std::array<std::uint32_t, 2>> links{};
    std::vector<double> volumes{};
    std::vector<std::vector<link_index>> of_cell{};

    plain_network(std::size_t cells, std::vector<std::array<std::uint32_t, 2>> edges, std::uint64_t seed = 1)
        : links(std::move(edges)), volumes(cells), of_cell(cells) {
        stream random(seed, stage::user, 0);
        for (double& v : volumes) v = random.chance(0.5) ? 1.0 : random.uniform(0.1, 3.0);
        for (std::size_t l = 0; l < links.size(); ++l) {
            of_cell[links[l][0]].push_back(link_index{l});
            if (links[l][1] != links[l][0]) of_cell[links[l][1]].push_back(link_index{l});
        }
    }
    std::size_t cell_count() const { return volumes.size(); }
    double cell_volume(cell_index c) const { return volumes[c.value]; }
    std::size_t link_count() const { return links.size(); }
    bool has_link(link_index) const { return true; }
    std::array<cell_index, 2> link_cells(link_index l) const {
        return {cell_index{links[l.value][0]}, cell_index{links[l.value][1]}};
    }
    double link_area(link_index) const { return 1; }
    vec3 link_centroid(link_index) const { return {0, 0, 0}; }
    vec3 link_normal(link_index) const { return {1, 0, 0}; }
    template <class V>
    void for_each_cell_link(cell_index c, V&& visit) const {
        for (link_index const l : of_cell[c.value]) visit(l);
    }
    template <class V>
    void for_each_neighbor(link_index, V&&) const {}
};
static_assert(link_network<plain_network>);

/// Components by union-find over what is left: knows nothing of how it came to be.
struct union_find {
    std::vector<std::uint32_t> up;
    explicit union_find(std::size_t n) : up(n) { std::iota(up.begin(), up.end(), 0U); }
    std::uint32_t root(std::uint32_t x) {
        while (up[x] != x) x = up[x] = up[up[x]];
        return x;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a != b) up[std::max(a, b)] = std::min(a, b);
    }
};

struct model {
    plain_network net;
    std::vector<char> bonded;
    std::vector<char> alive;
    std::vector<char> core;

    explicit model(plain_network n)
        : net(std::move(n)), bonded(net.links.size(), 1), alive(net.cell_count(), 1), core(net.cell_count(), 0) {}

    union_find components() const {
        union_find u(net.cell_count());
        for (std::size_t l = 0; l < net.links.size(); ++l) {
            auto const [a, b] = net.links[l];
            if (bonded[l] && alive[a] && alive[b]) u.join(a, b);
        }
        return u;
    }
};

plain_network random_graph(stream& random) {
    std::size_t const kind = random.index_below(5);
    std::vector<std::array<std::uint32_t, 2>> e;
    std::size_t n = 2 + random.index_below(40);
    auto const any = [&] { return static_cast<std::uint32_t>(random.index_below(n)); };
    if (kind == 0) {  // sparse, with several edges between the same cells and self links
        std::size_t const m = random.index_below(3 * n);
        for (std::size_t i = 0; i < m; ++i) {
            std::uint32_t const a = any();
            std::uint32_t const b = any();
            e.push_back({a, b});
            if (random.chance(0.2)) e.push_back({b, a});
        }
    } else if (kind == 1) {  // a tree: every bond is a bridge
        for (std::uint32_t i = 1; i < n; ++i) e.push_back({static_cast<std::uint32_t>(random.index_below(i)), i});
    } else if (kind == 2) {  // a grid
        std::uint32_t const w = 2 + static_cast<std::uint32_t>(random.index_below(6));
        std::uint32_t const h = 2 + static_cast<std::uint32_t>(random.index_below(6));
        n = w * h;
        for (std::uint32_t y = 0; y < h; ++y) {
            for (std::uint32_t x = 0; x < w; ++x) {
                if (x + 1 < w) e.push_back({y * w + x, y * w + x + 1});
                if (y + 1 < h) e.push_back({y * w + x, y * w + x + w});
            }
        }
    } else if (kind == 3) {  // two clumps and a bridge
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = i + 1; j < n; ++j) {
                if ((i < n / 2) == (j < n / 2) && random.chance(0.5)) e.push_back({i, j});
            }
        }
        e.push_back({0, static_cast<std::uint32_t>(n - 1)});
    } else {  // a path and a ring
        for (std::uint32_t i = 0; i + 1 < n; ++i) e.push_back({i, i + 1});
        if (random.chance(0.5)) e.push_back({static_cast<std::uint32_t>(n - 1), 0});
    }
    return plain_network(n, e, random.bits());
}

/// Labels, totals and enumerated cells equal those of the union-find (exact mode only).
void require_equal(model const& m, connectivity& c) {
    auto u = m.components();
    std::map<std::uint32_t, std::uint32_t> name;
    std::map<std::uint32_t, std::vector<cell_index>> members;
    for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
        REQUIRE(c.is_removed(cell_index{i}) == (m.alive[i] == 0));
        if (m.alive[i]) members[u.root(i)].push_back(cell_index{i});
    }
    std::set<std::uint32_t> used;
    for (auto const& [root, cells] : members) {
        std::uint32_t const k = c.component_of(cells.front());
        REQUIRE(used.insert(k).second);
        std::int64_t volume = 0;
        std::size_t cores = 0;
        for (cell_index const x : cells) {
            REQUIRE(c.component_of(x) == k);
            volume += c.fixed_volume(x);
            cores += m.core[x.value] ? 1U : 0U;
        }
        REQUIRE(c.totals(k).volume == volume);
        REQUIRE(c.totals(k).core_cells == cores);
        REQUIRE(c.cells_in(k) == cells.size());
        auto const listed = c.cells_of(k);
        REQUIRE(std::vector<cell_index>(listed.begin(), listed.end()) == cells);
    }
}

}  // namespace

TEST_CASE("connectivity agrees with union-find after every break, mark and removal of random graphs", "[law12]") {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 7);
        model m(random_graph(random));
        connectivity c(m.net, {.when_both_hold_core = two_cores::search});
        require_equal(m, c);
        for (int step = 0; step < 60; ++step) {
            std::uint64_t const what = random.index_below(10);
            if (what < 6 && !m.net.links.empty()) {
                link_index const l{static_cast<std::uint32_t>(random.index_below(m.net.links.size()))};
                auto const [a, b] = m.net.links[l.value];
                auto before = m.components();
                bool const was_together = m.alive[a] && m.alive[b] && before.root(a) == before.root(b);
                bool const was_bonded = m.bonded[l.value] && m.alive[a] && m.alive[b] && a != b;
                REQUIRE(c.is_bonded(m.net, l) == was_bonded);
                m.bonded[l.value] = 0;
                auto after = m.components();
                auto const s = c.break_link(m.net, l);
                bool const parted = was_together && after.root(a) != after.root(b);
                REQUIRE(s.has_value() == parted);
                if (s) {
                    REQUIRE(s->components[0] == c.component_of(cell_index{a}));
                    REQUIRE(s->components[1] == c.component_of(cell_index{b}));
                    REQUIRE(s->first.volume == c.totals(s->components[0]).volume);
                    REQUIRE(s->second.volume == c.totals(s->components[1]).volume);
                    if (s->first.volume == s->second.volume) {
                        REQUIRE(s->first.lowest_cell == c.cells_of(s->components[0]).front());
                        REQUIRE(s->second.lowest_cell == c.cells_of(s->components[1]).front());
                    }
                    if (random.chance(0.2)) {
                        auto const cells = c.cells_of(s->components[1]);
                        for (cell_index const x : cells) m.alive[x.value] = 0;
                        c.remove_component(s->components[1]);
                    }
                }
            } else if (what < 8) {
                cell_index const x{static_cast<std::uint32_t>(random.index_below(m.net.cell_count()))};
                m.core[x.value] = random.chance(0.5) ? 1 : 0;
                c.set_core(x, m.core[x.value] != 0);
            } else {
                std::vector<cell_index> gone;
                std::uint64_t const count = random.index_below(3);
                for (std::uint64_t i = 0; i < count; ++i) {
                    gone.push_back(cell_index{static_cast<std::uint32_t>(random.index_below(m.net.cell_count()))});
                    m.alive[gone.back().value] = 0;
                }
                c.remove_cells(gone);
            }
            require_equal(m, c);
        }
    }
}

TEST_CASE("a batch of breaks gives the fragments that the breaks give one by one", "[law12]") {
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 8);
        model m(random_graph(random));
        connectivity c(m.net, {.when_both_hold_core = two_cores::search});
        for (int round = 0; round < 5; ++round) {
            auto before = m.components();
            std::vector<link_index> batch;
            double const p = random.uniform01() * 0.6;
            for (std::size_t l = 0; l < m.net.links.size(); ++l) {
                if (random.chance(p)) {
                    batch.push_back(link_index{l});
                    m.bonded[l] = 0;
                }
            }
            auto const got = c.break_links(m.net, batch);
            std::vector<fragment> const fragments(got.begin(), got.end());
            auto after = m.components();
            std::map<std::uint32_t, std::set<std::uint32_t>> pieces;
            for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) pieces[before.root(i)].insert(after.root(i));
            std::size_t expected = 0;
            for (auto const& [old, roots] : pieces) expected += roots.size() > 1 ? roots.size() : 0;
            REQUIRE(fragments.size() == expected);
            std::map<std::uint32_t, std::uint32_t> group_of;
            for (fragment const& f : fragments) {
                auto const cells = c.cells_of(f.component);
                std::int64_t volume = 0;
                for (cell_index const x : cells) volume += c.fixed_volume(x);
                REQUIRE(f.totals.volume == volume);
                auto const old = before.root(cells.front().value);
                REQUIRE(group_of.emplace(old, f.group).first->second == f.group);
            }
            require_equal(m, c);
        }
    }
}

TEST_CASE("with early stopping exactly the pieces without core are reported to fall", "[law12]") {
    for (std::uint64_t seed = 0; seed < 800; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 9);
        model m(random_graph(random));
        connectivity c(m.net);
        double const share = random.uniform01() * 0.5;
        for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
            m.core[i] = random.chance(share) ? 1 : 0;
            c.set_core(cell_index{i}, m.core[i] != 0);
        }
        auto start = m.components();
        std::set<std::uint32_t> held;  // components that held core cells at the start
        for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
            if (m.core[i]) held.insert(start.root(i));
        }
        for (int step = 0; step < 40 && !m.net.links.empty(); ++step) {
            std::vector<link_index> batch(1 + random.index_below(4));
            for (link_index& l : batch) {
                l = link_index{static_cast<std::uint32_t>(random.index_below(m.net.links.size()))};
                m.bonded[l.value] = 0;
            }
            std::vector<fragment> fragments;
            if (batch.size() == 1) {
                if (auto const s = c.break_link(m.net, batch[0])) {
                    fragments = {{s->first, s->components[0], 0}, {s->second, s->components[1], 0}};
                }
            } else {
                auto const got = c.break_links(m.net, batch);
                fragments.assign(got.begin(), got.end());
            }
            // Groups of which some hold core: those without fall.
            std::set<std::uint32_t> with_core;
            for (fragment const& f : fragments) {
                if (f.totals.core_cells > 0) with_core.insert(f.group);
            }
            for (fragment const& f : fragments) {
                if (f.totals.core_cells > 0 || !with_core.contains(f.group)) continue;
                for (cell_index const x : c.cells_of(f.component)) m.alive[x.value] = 0;
                c.remove_component(f.component);
            }
            auto now = m.components();
            std::set<std::uint32_t> cored;
            for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
                if (m.alive[i] && m.core[i]) cored.insert(now.root(i));
            }
            for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
                if (held.contains(start.root(i))) {
                    REQUIRE((m.alive[i] != 0) == (cored.contains(now.root(i)) || m.core[i]));
                } else {
                    REQUIRE(m.alive[i] != 0);
                }
                REQUIRE(c.is_removed(cell_index{i}) == (m.alive[i] == 0));
            }
        }
        // Unmarking every core must leave exact labels behind.
        for (std::uint32_t i = 0; i < m.net.cell_count(); ++i) {
            m.core[i] = 0;
            c.set_core(cell_index{i}, false);
        }
        require_equal(m, c);
    }
}

TEST_CASE("a batch too long to search is flooded, with the same fragments", "[law12]") {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        stream random(seed, stage::user, 10);
        // A long ring: every search runs half way round, so a batch is given up soon.
        std::uint32_t const n = 6000;
        std::vector<std::array<std::uint32_t, 2>> e;
        for (std::uint32_t i = 0; i < n; ++i) e.push_back({i, (i + 1) % n});
        model m(plain_network(n, e, seed));
        connectivity c(m.net, {.when_both_hold_core = seed % 2 == 0 ? two_cores::search : two_cores::stop});
        for (int round = 0; round < 3; ++round) {
            std::vector<link_index> batch;
            for (int i = 0; i < 400; ++i) {
                batch.push_back(link_index{static_cast<std::uint32_t>(random.index_below(n))});
                m.bonded[batch.back().value] = 0;
            }
            c.break_links(m.net, batch);
            require_equal(m, c);
            std::vector<cell_index> gone;
            for (int i = 0; i < 100; ++i) {
                gone.push_back(cell_index{static_cast<std::uint32_t>(random.index_below(n))});
                m.alive[gone.back().value] = 0;
            }
            c.remove_cells(gone);
            require_equal(m, c);
        }
    }
}

TEST_CASE("what is left of cells and bonds restores connectivity") {
    stream random(1, stage::user, 11);
    model m(random_graph(random));
    connectivity c(m.net, {.when_both_hold_core = two_cores::search});
    for (std::size_t l = 0; l < m.net.links.size(); l += 3) {
        m.bonded[l] = 0;
        c.break_link(m.net, link_index{l});
    }
    m.alive[0] = 0;
    c.remove_cell(cell_index{0U});
    m.core[1] = 1;
    std::vector<cell_state> states(m.net.cell_count(), cell_state::solid);
    states[0] = cell_state::air;
    states[1] = cell_state::core;
    connectivity restored(m.net, states, [&](link_index l) { return m.bonded[l.value] != 0; });
    require_equal(m, restored);
    connectivity const snapshot = c;
    c.set_core(cell_index{1U}, true);
    require_equal(m, c);
    REQUIRE_FALSE(snapshot.is_core(cell_index{1U}));
    REQUIRE_THROWS_AS(connectivity(m.net, std::span{states}.first(1), [](link_index) { return true; }), invalid_input);
}

namespace {

/// A hub bonded to every cell of a ring: the last cell is the hub, links 0 .. n-1 its spokes, the rest the ring.
struct wheel {
    std::uint32_t n;
    std::size_t cell_count() const { return n + 1; }
    double cell_volume(cell_index) const { return 1; }
    std::size_t link_count() const { return 2 * std::size_t{n}; }
    bool has_link(link_index) const { return true; }
    std::array<cell_index, 2> link_cells(link_index l) const {
        if (l.value < n) return {cell_index{n}, cell_index{l.value}};
        return {cell_index{l.value - n}, cell_index{(l.value - n + 1) % n}};
    }
    double link_area(link_index) const { return 1; }
    vec3 link_centroid(link_index) const { return {0, 0, 0}; }
    vec3 link_normal(link_index) const { return {0, 0, 1}; }
    void for_each_cell_link(cell_index c, auto&& f) const {
        if (c.value == n) {
            for (std::uint32_t l = 0; l < n; ++l) f(link_index{l});
            return;
        }
        f(link_index{c.value});
        f(link_index{n + c.value});
        f(link_index{n + (c.value + n - 1) % n});
    }
    void for_each_neighbor(link_index, auto&&) const {}
};

/// Two cells with two bonds between them.
struct twins {
    std::size_t cell_count() const { return 2; }
    double cell_volume(cell_index) const { return 1; }
    std::size_t link_count() const { return 2; }
    bool has_link(link_index) const { return true; }
    std::array<cell_index, 2> link_cells(link_index) const { return {cell_index{0U}, cell_index{1U}}; }
    double link_area(link_index) const { return 1; }
    vec3 link_centroid(link_index) const { return {0, 0, 0}; }
    vec3 link_normal(link_index) const { return {0, 0, 1}; }
    void for_each_cell_link(cell_index, auto&& f) const {
        f(link_index{0U});
        f(link_index{1U});
    }
    void for_each_neighbor(link_index, auto&&) const {}
};

}  // namespace

TEST_CASE("a cell with fifty thousand bonds comes off when the last of them breaks") {
    wheel const w{50000};
    connectivity c(w);
    std::size_t parted = 0;
    for (std::uint32_t l = 0; l + 1 < w.n; ++l) parted += c.break_link(w, link_index{l}).has_value() ? 1U : 0U;
    CHECK(parted == 0);  // the ring holds its cells, the last spoke the hub
    CHECK(c.is_bonded(w, link_index{w.n - 1}));
    auto const last = c.break_link(w, link_index{w.n - 1});
    REQUIRE(last.has_value());
    CHECK(c.cells_in(last->components[0]) == 1);
    CHECK(c.cells_in(last->components[1]) == w.n);
    CHECK_FALSE(c.break_link(w, link_index{w.n - 1}).has_value());
    CHECK_FALSE(c.is_bonded(w, link_index{0U}));
}

TEST_CASE("of two bonds between the same cells each is known by itself") {
    twins const twin{};
    connectivity c(twin);
    CHECK_FALSE(c.break_link(twin, link_index{1U}).has_value());
    CHECK(c.is_bonded(twin, link_index{0U}));
    CHECK_FALSE(c.is_bonded(twin, link_index{1U}));
    CHECK_FALSE(c.break_link(twin, link_index{1U}).has_value());  // no second time
    CHECK(c.is_bonded(twin, link_index{0U}));
    CHECK(c.break_link(twin, link_index{0U}).has_value());
}
