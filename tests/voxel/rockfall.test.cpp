#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/rockfall.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <vector>

namespace {

using namespace tafoni;

constexpr grid_border on_the_ground{{border_kind::air, border_kind::air, border_kind::air, border_kind::air,
                                     border_kind::rock, border_kind::air}};
rockfall_options const no_ground{.sides = {ground_side::loose, ground_side::loose, ground_side::loose,
                                           ground_side::loose, ground_side::loose, ground_side::loose}};

void fill(sparse_grid& g, voxel lo, voxel hi, voxel_state s = voxel_state::rock) {
    for (auto z = lo.z; z <= hi.z; ++z) {
        for (auto y = lo.y; y <= hi.y; ++y) {
            for (auto x = lo.x; x <= hi.x; ++x) g.set({x, y, z}, s);
        }
    }
}

/// Removes rock and lets fall what comes loose.
std::vector<fallen_block> remove(sparse_grid& g, rockfall& fall, std::vector<voxel> const& gone,
                                 std::uint64_t step = 1) {
    for (voxel const v : gone) g.set(v, voxel_state::air);
    std::vector<voxel_change> changes;
    auto blocks = fall.fall(g, gone, step, inline_executor{}, changes);
    std::vector<voxel_change> expected;
    for (fallen_block const& b : blocks) {
        REQUIRE(b.step == step);
        REQUIRE(std::is_sorted(b.voxels.begin(), b.voxels.end()));
        for (voxel const v : b.voxels) expected.push_back({v, voxel_state::rock, voxel_state::air});
    }
    std::sort(expected.begin(), expected.end(), [](auto const& a, auto const& b) { return a.at < b.at; });
    REQUIRE(changes == expected);
    for (voxel_change const& c : changes) REQUIRE(g.state(c.at) == voxel_state::air);
    return blocks;
}

/// What falls by the rules as written, from nothing but the grid: components by union-find over voxels, joints bond
/// by bond, friction piece by piece, again until nothing falls.
class oracle {
public:
    oracle(sparse_grid const& g, rockfall_options const& options) : grid_(g), options_(options) {
        for (joint_disc const& d : options.joints.discs) planes_.push_back(detail::joint_plane::of(d));
    }

    std::vector<fallen_block> fall(std::uint64_t step) {
        std::vector<fallen_block> out;
        for (;;) {
            auto const pieces = components();
            std::vector<bool> stands(pieces.size());
            bool any_ground = false;
            for (std::size_t p = 0; p < pieces.size(); ++p) {
                for (voxel const v : pieces[p]) stands[p] = stands[p] || is_ground(v);
                any_ground = any_ground || stands[p];
            }
            if (!any_ground && !pieces.empty()) {
                std::size_t best = 0;
                for (std::size_t p = 1; p < pieces.size(); ++p) {
                    if (pieces[p].size() > pieces[best].size()) best = p;
                }
                stands[best] = true;
            } else if (options_.friction_angle > 0) {
                rest(pieces, stands);
            }
            bool fell = false;
            for (std::size_t p = 0; p < pieces.size(); ++p) {
                if (stands[p]) continue;
                fell = true;
                for (voxel const v : pieces[p]) grid_.set(v, voxel_state::air);
                out.push_back({step, pieces[p]});
            }
            if (!fell) break;
        }
        std::sort(out.begin(), out.end(), [](auto const& a, auto const& b) { return a.voxels[0] < b.voxels[0]; });
        return out;
    }
    sparse_grid const& grid() const { return grid_; }
    void remove(voxel v) { grid_.set(v, voxel_state::air); }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    std::size_t place(voxel v) const {
        return static_cast<std::size_t>(v.x) +
               grid_.size()[0] * (static_cast<std::size_t>(v.y) + grid_.size()[1] * static_cast<std::size_t>(v.z));
    }
    std::size_t at(voxel v) const { return grid_.contains(v) ? index_[place(v)] : none; }
    bool cut(voxel a, voxel b) const {
        return std::any_of(planes_.begin(), planes_.end(),
                           [&](auto const& p) { return p.cuts(grid_.centre(a), grid_.centre(b)); });
    }
    bool is_ground(voxel v) const {
        voxel const u = grid_.to_user(v);
        auto const& n = grid_.user_frame().size;
        std::array<std::int32_t, 3> const at{u.x, u.y, u.z};
        for (std::size_t s = 0; s < 6; ++s) {
            if (at[s / 2] != (s % 2 == 0 ? 0 : static_cast<std::int32_t>(n[s / 2]) - 1)) continue;
            if (options_.sides[s] == ground_side::ground) return true;
            if (options_.sides[s] == ground_side::loose) continue;
            // The neighbour beyond this side, in turned axes.
            voxel w = u;
            (s / 2 == 0 ? w.x : s / 2 == 1 ? w.y : w.z) += s % 2 == 0 ? -1 : 1;
            voxel const t = grid_.from_user(w);
            bool const is_up = t == v + voxel{0, 0, 1};
            if (!is_up && grid_.is_rock(t)) return true;
        }
        return std::find(options_.ground_voxels.begin(), options_.ground_voxels.end(), u) !=
                   options_.ground_voxels.end() ||
               (options_.ground_where && options_.ground_where(grid_.centre(v)));
    }
    std::vector<std::vector<voxel>> components() {
        std::vector<voxel> rock;
        auto const& n = grid_.size();
        for (std::int32_t z = 0; z < static_cast<std::int32_t>(n[2]); ++z) {
            for (std::int32_t y = 0; y < static_cast<std::int32_t>(n[1]); ++y) {
                for (std::int32_t x = 0; x < static_cast<std::int32_t>(n[0]); ++x) {
                    if (grid_.is_rock({x, y, z})) rock.push_back({x, y, z});
                }
            }
        }
        index_.assign(n[0] * n[1] * n[2], none);
        for (std::size_t i = 0; i < rock.size(); ++i) index_[place(rock[i])] = i;
        parent_.resize(rock.size());
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        for (voxel const v : rock) {
            for (voxel const d : {voxel{1, 0, 0}, voxel{0, 1, 0}, voxel{0, 0, 1}}) {
                std::size_t const w = at(v + d);
                if (w == none || cut(v, v + d)) continue;
                std::size_t const a = root(at(v));
                std::size_t const b = root(w);
                parent_[std::max(a, b)] = std::min(a, b);
            }
        }
        std::map<std::size_t, std::vector<voxel>> by_root;
        for (std::size_t i = 0; i < rock.size(); ++i) by_root[root(i)].push_back(rock[i]);
        std::vector<std::vector<voxel>> out;
        piece_.assign(rock.size(), 0);
        for (auto& [r, voxels] : by_root) {
            for (voxel const v : voxels) piece_[at(v)] = out.size();
            out.push_back(std::move(voxels));
        }
        return out;
    }
    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void rest(std::vector<std::vector<voxel>> const& pieces, std::vector<bool>& stands) const {
        auto const axis = grid_.rotation().axis;
        std::vector<std::set<std::size_t>> on(pieces.size());
        std::vector<bool> flat(pieces.size());
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            double x = 0;
            double y = 0;
            double n = 0;
            for (voxel const v : pieces[p]) {
                voxel const w = v - voxel{0, 0, 1};
                std::size_t const under = at(w);
                if (under == none || piece_[under] == p) continue;
                on[p].insert(piece_[under]);
                vec3 steep{0, 0, 2};
                for (auto const& plane : planes_) {
                    if (!plane.cuts(grid_.centre(w), grid_.centre(v))) continue;
                    vec3 turned{plane.normal[axis[0]], plane.normal[axis[1]], plane.normal[axis[2]]};
                    for (int k = 0; k < 3; ++k) {
                        turned[k] *= grid_.rotation().mirrored[static_cast<std::size_t>(k)] ? -1.0 : 1.0;
                    }
                    if (turned[2] < 0) turned = vec3{-turned[0], -turned[1], -turned[2]};
                    if (turned[2] < steep[2]) steep = turned;
                }
                REQUIRE(steep[2] <= 1);
                x += steep[0] / steep[2];
                y += steep[1] / steep[2];
                n += 1;
            }
            flat[p] = n > 0 && std::atan2(std::sqrt(x * x + y * y), n) <=
                                   options_.friction_angle * 3.14159265358979 / 180 + 1e-9;
        }
        for (bool again = true; again;) {
            again = false;
            for (std::size_t p = 0; p < pieces.size(); ++p) {
                if (stands[p] || !flat[p]) continue;
                if (std::any_of(on[p].begin(), on[p].end(), [&](std::size_t q) { return stands[q]; })) {
                    stands[p] = true;
                    again = true;
                }
            }
        }
    }

    sparse_grid grid_;
    rockfall_options options_;
    std::vector<detail::joint_plane> planes_{};
    std::vector<std::size_t> index_{};
    std::vector<std::size_t> parent_{};
    std::vector<std::size_t> piece_{};
};

/// Random rock, taken away in random batches: every call must do what the rules say of the grid as it is.
std::size_t compare_with_oracle(std::uint64_t seed, std::array<std::size_t, 3> size, std::size_t batch,
                                std::size_t steps, rockfall_options options, double density,
                                up_axis up = up_axis::plus_z) {
    stream draw(seed, stage::user, 0);
    grid_border border;
    for (auto& s : border.sides) s = draw.index_below(3) == 0 ? border_kind::rock : border_kind::air;
    sparse_grid g({.size = size, .spacing = {1, 0.5, 2}, .origin = {-3, 1, 0}}, up, border);
    auto const& n = g.size();
    std::vector<voxel> rock;
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(n[2]); ++z) {
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(n[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(n[0]); ++x) {
                double const u = draw.uniform01();
                if (u < density) {
                    g.set({x, y, z}, voxel_state::rock);
                    rock.push_back({x, y, z});
                } else if (u > 0.97) {
                    g.set({x, y, z}, voxel_state::colluvium);
                }
            }
        }
    }
    for (std::size_t i = rock.size(); i > 1; --i) std::swap(rock[i - 1], rock[draw.index_below(i)]);
    oracle truth(g, options);
    rockfall fall(options);
    std::size_t fallen = 0;
    for (std::size_t step = 0; step < steps; ++step) {
        std::vector<voxel> gone;
        for (std::size_t i = 0; i < batch && step > 0; ++i) {
            while (!rock.empty() && !g.is_rock(rock.back())) rock.pop_back();
            if (rock.empty()) break;
            truth.remove(rock.back());
            g.set(rock.back(), voxel_state::air);
            gone.push_back(rock.back());
            rock.pop_back();
        }
        if (step % 4 == 3) fall = rockfall(options);  // goes on as if nothing had happened
        std::vector<voxel_change> changes;
        auto const blocks = fall.fall(g, gone, step, inline_executor{}, changes);
        auto const expected = truth.fall(step);
        INFO("seed " << seed << " step " << step);
        REQUIRE(blocks == expected);
        for (auto const& b : blocks) fallen += b.voxels.size();
    }
    return fallen;
}

/// Rock in cubes of `cube` voxels, bitten by balls: bricks of nothing but rock, faces between bricks, large pieces.
std::size_t compare_large(std::uint64_t seed, std::array<std::size_t, 3> size, std::int32_t cube,
                          rockfall_options const& options, std::size_t steps) {
    stream draw(seed, stage::user, 2);
    grid_border border = on_the_ground;
    if (seed % 3 == 1)
        border.sides = {border_kind::extend, border_kind::air, border_kind::air,
                        border_kind::rock,   border_kind::air, border_kind::rock};
    sparse_grid g({.size = size, .spacing = {0.25, 0.25, 0.25}, .origin = {-3, 1, 0}}, up_axis::plus_z, border);
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](voxel v) {
            stream of_cube(seed, stage::user + 1,
                           static_cast<std::uint64_t>(v.x / cube + 64 * (v.y / cube + 64 * (v.z / cube))));
            return of_cube.chance(0.6) ? voxel_state::rock : voxel_state::air;
        });
    }
    oracle truth(g, options);
    rockfall fall(options);
    std::size_t fallen = 0;
    for (std::size_t step = 0; step < steps; ++step) {
        std::vector<voxel> gone;
        for (std::size_t i = 0; i < 6 && step > 0; ++i) {
            voxel c;
            c.x = static_cast<std::int32_t>(draw.index_below(size[0]));
            c.y = static_cast<std::int32_t>(draw.index_below(size[1]));
            c.z = static_cast<std::int32_t>(draw.index_below(size[2]));
            auto const r = static_cast<std::int32_t>(2 + draw.index_below(9));
            for (std::int32_t dz = -r; dz <= r; ++dz) {
                for (std::int32_t dy = -r; dy <= r; ++dy) {
                    for (std::int32_t dx = -r; dx <= r; ++dx) {
                        voxel const v = c + voxel{dx, dy, dz};
                        if (dx * dx + dy * dy + dz * dz > r * r || !g.contains(v) || !g.is_rock(v)) continue;
                        truth.remove(v);
                        g.set(v, voxel_state::air);
                        gone.push_back(v);
                    }
                }
            }
        }
        std::vector<voxel_change> changes;
        auto const blocks = fall.fall(g, gone, step, inline_executor{}, changes);
        for (std::size_t b = 0; b < g.brick_count() && step % 2 == 0; ++b) g.compact(b);
        INFO("seed " << seed << " step " << step);
        REQUIRE(blocks == truth.fall(step));
        for (auto const& b : blocks) fallen += b.voxels.size();
    }
    return fallen;
}

joint_set random_cracks(std::uint64_t seed, std::size_t count, double radius) {
    stream draw(seed, stage::user, 1);
    joint_set out;
    for (std::size_t i = 0; i < count; ++i) {
        vec3 const n = draw.unit_vector();
        double const x = draw.uniform(-3, 9);
        double const y = draw.uniform(1, 7);
        double const z = draw.uniform(0, 24);
        out.discs.push_back({.centre = {x, y, z}, .normal = {n[0], n[1], n[2] * 3}, .radius = radius});
    }
    return out;
}

}  // namespace

TEST_CASE("rock falls as a full relabel by voxels says, batch after batch", "[rockfall]") {
    std::size_t fallen = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        std::size_t const batch = 1 + seed % 7 * 5;
        fallen += compare_with_oracle(seed, {9, 7, 8}, batch, 12, {}, 0.35 + 0.01 * static_cast<double>(seed));
        fallen += compare_with_oracle(seed, {9, 7, 8}, batch, 12, no_ground, 0.35 + 0.01 * static_cast<double>(seed));
    }
    CHECK(fallen > 1000);
}

TEST_CASE("joints and friction decide as the rules say of the grid, batch after batch", "[rockfall]") {
    std::size_t fallen = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        rockfall_options options{.joints = random_cracks(seed, 1 + seed % 9, 3 + static_cast<double>(seed % 5) * 4),
                                 .friction_angle = static_cast<double>(seed % 4) * 20};
        auto const up = static_cast<up_axis>(seed % 6);
        fallen += compare_with_oracle(seed, {10, 9, 11}, 1 + seed % 40, 8, options,
                                      0.6 + 0.006 * static_cast<double>(seed), up);
    }
    CHECK(fallen > 1000);
}

TEST_CASE("across bricks, solid or not, rock falls as a full relabel by voxels says", "[rockfall]") {
    std::size_t fallen = 0;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        fallen += compare_large(seed, {70, 40, 65}, seed % 2 == 0 ? 8 : 32,
                                seed % 4 == 3 ? no_ground : rockfall_options{}, 6);
        fallen += compare_large(
            seed, {70, 40, 65}, seed % 2 == 0 ? 32 : 16,
            {.joints = random_cracks(seed, 5, 20), .friction_angle = static_cast<double>(seed % 3) * 25}, 4);
    }
    CHECK(fallen > 10000);
}

TEST_CASE("many more random rocks fall as a full relabel by voxels says", "[rockfall][slow]") {
    for (std::uint64_t seed = 1000; seed < 1350; ++seed) {
        double const density = 0.3 + 0.002 * static_cast<double>(seed - 1000);
        compare_with_oracle(seed, {9, 7, 8}, 1 + seed % 23, 12, seed % 3 == 0 ? no_ground : rockfall_options{},
                            density);
        compare_with_oracle(seed, {10, 9, 11}, 1 + seed % 23, 8,
                            {.joints = random_cracks(seed, 1 + seed % 12, 1 + static_cast<double>(seed % 5) * 4),
                             .friction_angle = static_cast<double>(seed % 4) * 20},
                            density, static_cast<up_axis>(seed % 6));
    }
    for (std::uint64_t seed = 100; seed < 110; ++seed) {
        compare_large(seed, {100, 70, 66},
                      seed % 3 == 0   ? 8
                      : seed % 3 == 1 ? 16
                                      : 32,
                      seed % 4 == 3 ? no_ground : rockfall_options{}, 6);
        compare_large(
            seed, {70, 70, 66}, seed % 2 == 0 ? 32 : 8,
            {.joints = random_cracks(seed, 1 + seed % 9, 30), .friction_angle = static_cast<double>(seed % 3) * 25}, 4);
    }
}

TEST_CASE("a bridge cut at both ends falls, cut at one end it stays", "[rockfall]") {
    sparse_grid g({.size = {80, 5, 40}}, up_axis::plus_z, on_the_ground);
    fill(g, {2, 1, 0}, {9, 3, 30});
    fill(g, {70, 1, 0}, {77, 3, 30});
    fill(g, {2, 1, 31}, {77, 3, 34});
    rockfall fall;
    CHECK(remove(g, fall, {}).empty());
    std::vector<voxel> left;
    std::vector<voxel> right;
    for (std::int32_t y = 1; y <= 3; ++y) {
        for (std::int32_t z = 31; z <= 34; ++z) {
            left.push_back({15, y, z});
            right.push_back({60, y, z});
        }
    }
    CHECK(remove(g, fall, left).empty());
    auto const fallen = remove(g, fall, right, 7);
    REQUIRE(fallen.size() == 1);
    CHECK(fallen[0].voxels.size() == 44U * 3 * 4);
    CHECK(fallen[0].voxels.front() == voxel{16, 1, 31});
    CHECK(g.count(voxel_plane::rock) == 2U * 8 * 3 * 31 + (13 + 17) * 3 * 4);
}

TEST_CASE("a cap falls with its pillar, whatever axis is up", "[rockfall]") {
    for (int a = 0; a < 6; ++a) {
        auto const up = static_cast<up_axis>(a);
        grid_border border;  // rock below, in the user's axes
        border.sides[std::array<std::size_t, 6>{4, 0, 2, 5, 1, 3}[static_cast<std::size_t>(a)]] = border_kind::rock;
        sparse_grid g({.size = {40, 40, 40}}, up, border);
        fill(g, {20, 20, 0}, {20, 20, 35});
        fill(g, {10, 10, 36}, {30, 30, 38});
        rockfall fall;
        CHECK(remove(g, fall, {}).empty());
        auto const fallen = remove(g, fall, {{20, 20, 12}});
        REQUIRE(fallen.size() == 1);
        CHECK(fallen[0].voxels.size() == 23U + 21 * 21 * 3);
        CHECK(g.count(voxel_plane::rock) == 12);
    }
}

TEST_CASE("edges, corners and colluvium hold no rock", "[rockfall]") {
    sparse_grid g({.size = {8, 8, 8}}, up_axis::plus_z, on_the_ground);
    g.set({1, 1, 0}, voxel_state::rock);
    g.set({2, 1, 1}, voxel_state::rock);        // edge
    g.set({2, 2, 2}, voxel_state::rock);        // edge
    g.set({3, 3, 3}, voxel_state::rock);        // corner
    g.set({6, 6, 0}, voxel_state::colluvium);
    g.set({6, 6, 1}, voxel_state::rock);
    rockfall fall;
    CHECK(fall.loose(g, inline_executor{}).size() == 4);
    CHECK(remove(g, fall, {}).size() == 4);
    CHECK(g.count(voxel_plane::rock) == 1);
    CHECK(g.state({6, 6, 0}) == voxel_state::colluvium);

    sparse_grid board({.size = {8, 8, 8}}, up_axis::plus_z, on_the_ground);
    for (std::int32_t i = 0; i < 512; ++i) {
        voxel const v{i & 7, i >> 3 & 7, i >> 6};
        if (((v.x + v.y + v.z) & 1) == 0) board.set(v, voxel_state::rock);
    }
    rockfall other;
    CHECK(remove(board, other, {}).size() == 256U - 32);
    CHECK(board.count(voxel_plane::rock) == 32);
}

TEST_CASE("ground is where the options say", "[rockfall]") {
    auto const left = [](grid_border const& border, rockfall_options options) {
        sparse_grid g({.size = {9, 9, 9}}, up_axis::plus_z, border);
        for (voxel const v : {voxel{0, 4, 4}, voxel{8, 4, 4}, voxel{4, 0, 4}, voxel{4, 8, 4}, voxel{4, 4, 0},
                              voxel{4, 4, 8}, voxel{4, 4, 4}}) {
            g.set(v, voxel_state::rock);
        }
        rockfall fall(std::move(options));
        remove(g, fall, {});
        std::vector<voxel> out;
        for (std::int32_t z = 0; z < 9; ++z) {
            for (std::int32_t y = 0; y < 9; ++y) {
                for (std::int32_t x = 0; x < 9; ++x) {
                    if (g.is_rock({x, y, z})) out.push_back({x, y, z});
                }
            }
        }
        return out;
    };
    grid_border all_rock;
    all_rock.sides.fill(border_kind::rock);
    grid_border two;
    two.sides[0] = border_kind::extend;
    two.sides[4] = border_kind::rock;
    CHECK(left({}, {}) ==
          std::vector<voxel>{{4, 4, 0}});  // none: the largest, of equal ones that with the lowest voxel
    CHECK(left(all_rock, {}).size() == 5);                 // not the top
    CHECK(left(two, {}) == std::vector<voxel>{{4, 4, 0}, {0, 4, 4}});
    CHECK(left({}, {.sides = {ground_side::by_border, ground_side::by_border, ground_side::by_border,
                              ground_side::by_border, ground_side::by_border, ground_side::ground}}) ==
          std::vector<voxel>{{4, 4, 8}});
    CHECK(left(all_rock, no_ground) == std::vector<voxel>{{4, 4, 0}});
    CHECK(left({}, {.ground_voxels = {{4, 4, 4}, {5, 5, 5}, {-1, 0, 99}}}) == std::vector<voxel>{{4, 4, 4}});
    // Named voxels may lie as far away as numbers go, also along an axis that is turned round.
    constexpr auto least = std::numeric_limits<std::int32_t>::min();
    constexpr auto most = std::numeric_limits<std::int32_t>::max();
    for (auto const up : {up_axis::minus_x, up_axis::minus_y, up_axis::minus_z}) {
        sparse_grid turned({.size = {3, 4, 5}}, up);
        turned.set({1, 1, 1}, voxel_state::rock);
        std::vector<voxel_change> changes;
        rockfall far_ground({.ground_voxels = {{least, least, least}, {most, most, most}, {0, least, most}}});
        CHECK(far_ground.fall(turned, {}, 0, inline_executor{}, changes).empty());
    }
    CHECK(left(two, {.ground_where = [](vec3 const& p) { return p[1] > 7; }}) ==
          std::vector<voxel>{{4, 4, 0}, {0, 4, 4}, {4, 8, 4}});
}

TEST_CASE("when the last ground goes the largest piece stays", "[rockfall]") {
    sparse_grid g({.size = {40, 40, 40}}, up_axis::plus_z, on_the_ground);
    fill(g, {5, 5, 0}, {5, 5, 9});
    fill(g, {5, 5, 10}, {34, 5, 10});
    fill(g, {20, 5, 0}, {20, 5, 9});
    fill(g, {34, 5, 0}, {34, 5, 9});
    rockfall fall;
    CHECK(remove(g, fall, {{5, 5, 0}, {20, 5, 0}}).empty());
    CHECK(remove(g, fall, {{34, 5, 0}, {12, 5, 10}}).size() == 1);
    CHECK(g.is_rock({34, 5, 5}));
    CHECK(remove(g, fall, {{20, 5, 10}}).size() == 2);
    CHECK(g.count(voxel_plane::rock) == 14U + 9);
}

TEST_CASE("a tilted joint through a block holds its upper part by friction alone", "[rockfall]") {
    auto const upper_that_fell = [](double tilt, double friction) {
        double const t = tilt * 3.14159265358979 / 180;
        sparse_grid g({.size = {24, 24, 40}, .spacing = {0.5, 0.5, 0.5}}, up_axis::plus_z, on_the_ground);
        fill(g, {4, 4, 0}, {19, 19, 35});
        rockfall fall({.joints = {{{.centre = {6, 6, 9}, .normal = {std::sin(t), 0, std::cos(t)}, .radius = 40}}},
                       .friction_angle = friction});
        auto const blocks = fall.loose(g, inline_executor{});
        remove(g, fall, {});
        REQUIRE(blocks.size() <= 1);
        return blocks.empty() ? 0U : blocks[0].voxels.size();
    };
    std::size_t const upper = upper_that_fell(20, 0);
    CHECK(std::abs(static_cast<double>(upper) - 16.0 * 16 * 18) < 16 * 16);
    CHECK(upper_that_fell(20, 30) == 0);
    CHECK(upper_that_fell(20, 10) == upper);
    CHECK(upper_that_fell(20, 19.9) == upper);
    CHECK(upper_that_fell(20, 20.1) == 0);
    CHECK(upper_that_fell(0, 0) == 16U * 16 * 18);
    CHECK(upper_that_fell(0, 1) == 0);
    CHECK(upper_that_fell(60, 59) > 1000);
    CHECK(upper_that_fell(60, 61) == 0);
}

TEST_CASE("a resting piece falls when what it rests on goes, and so does what rests on it", "[rockfall]") {
    sparse_grid g({.size = {20, 9, 40}}, up_axis::plus_z, on_the_ground);
    fill(g, {2, 2, 0}, {5, 5, 33});
    auto const slab = [](double z) { return joint_disc{.centre = {4, 4, z}, .normal = {0, 0, 1}, .radius = 20}; };
    rockfall_options const options{.joints = {{slab(10), slab(20), slab(32)}}, .friction_angle = 30};
    rockfall fall(options);
    CHECK(remove(g, fall, {}).empty());
    std::vector<voxel> layer;  // all that the second piece rests on but a corner
    for (std::int32_t i = 1; i < 16; ++i) layer.push_back({2 + i % 4, 2 + i / 4, 9});
    CHECK(remove(g, fall, layer).empty());
    auto const fallen = remove(g, fall, {{2, 2, 9}});
    REQUIRE(fallen.size() == 3);
    CHECK(fallen[0].voxels.size() == 160);
    CHECK(fallen[1].voxels.size() == 192);
    CHECK(fallen[2].voxels.size() == 32);
    CHECK(g.count(voxel_plane::rock) == 9U * 16);
}

TEST_CASE("without rock, with one voxel and with nothing but rock", "[rockfall]") {
    for (voxel const n : {voxel{1, 1, 1}, voxel{33, 2, 64}, voxel{64, 64, 64}}) {
        auto const d = [](std::int32_t i) { return static_cast<std::size_t>(i); };
        for (grid_border const& border : {grid_border{}, on_the_ground}) {
            sparse_grid air({.size = {d(n.x), d(n.y), d(n.z)}}, up_axis::plus_z, border);
            rockfall nothing;
            CHECK(remove(air, nothing, {}).empty());
            CHECK(remove(air, nothing, {}).empty());
            sparse_grid rock({.size = {d(n.x), d(n.y), d(n.z)}}, up_axis::plus_z, border);
            for (std::size_t b = 0; b < rock.brick_count(); ++b) {
                rock.fill_brick(b, [](voxel) { return voxel_state::rock; });
            }
            rockfall all;
            CHECK(remove(rock, all, {}).empty());
            CHECK(remove(rock, all, {{0, 0, 0}}).empty());
            CHECK(rock.count(voxel_plane::rock) == d(n.x) * d(n.y) * d(n.z) - 1);
        }
    }
}

TEST_CASE("what it costs depends on what is removed and not on the size of the rock", "[rockfall]") {
    std::vector<rockfall::effort_count> spent;
    for (std::int32_t const n : {64, 128, 256}) {
        auto const size = static_cast<std::size_t>(n);
        sparse_grid g({.size = {size, size, size}}, up_axis::plus_z, on_the_ground);
        for (std::size_t b = 0; b < g.brick_count(); ++b) {
            g.fill_brick(b, [&](voxel v) { return v.z < n - 8 ? voxel_state::rock : voxel_state::air; });
        }
        rockfall fall;
        remove(g, fall, {});
        auto const before = fall.effort();
        std::vector<voxel> flat;  // a layer of 40 x 40, then a tower in the open, cut at its foot
        for (std::int32_t i = 0; i < 1600; ++i) flat.push_back({5 + i % 40, 5 + i / 40, n - 9});
        CHECK(remove(g, fall, flat).empty());
        CHECK(fall.effort().bricks_labelled == before.bricks_labelled);
        for (std::int32_t depth = 10; depth < 14; ++depth) {
            std::vector<voxel> ring;
            for (std::int32_t i = 0; i < 1600; ++i) {
                voxel const v{5 + i % 40, 5 + i / 40, n - depth};
                if (v.x < 20 || v.x > 24 || v.y < 20 || v.y > 24) ring.push_back(v);
            }
            CHECK(remove(g, fall, ring).empty());
        }
        std::vector<voxel> foot;
        for (std::int32_t i = 0; i < 25; ++i) foot.push_back({20 + i % 5, 20 + i / 5, n - 13});
        auto const fallen = remove(g, fall, foot);
        REQUIRE(fallen.size() == 1);
        CHECK(fallen[0].voxels.size() == 75);
        auto const after = fall.effort();
        spent.push_back({after.bricks_labelled - before.bricks_labelled, after.faces_passed - before.faces_passed,
                         after.voxels_searched - before.voxels_searched});
    }
    CHECK(spent[0].voxels_searched == spent[2].voxels_searched);
    CHECK(spent[1].bricks_labelled == spent[2].bricks_labelled);
    CHECK(spent[2].bricks_labelled < 12);
    CHECK(spent[2].faces_passed < spent[1].faces_passed + 64);
}

TEST_CASE("pieces smaller than a brick cost what they measure", "[rockfall]") {
    sparse_grid g({.size = {64, 64, 64}}, up_axis::plus_z, {{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock, border_kind::air}});
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [](voxel v) { return (v.x + v.y + v.z) % 2 == 0 ? voxel_state::rock : voxel_state::air; });
    }
    rockfall falls;
    std::vector<voxel_change> changes;
    CHECK(falls.fall(g, {}, 0, inline_executor{}, changes).size() == 63 * 64 * 64 / 2);
    CHECK(g.count(voxel_plane::rock) == 64 * 64 / 2);
    // Single voxels: only those beside another brick, on two sides of three planes, are asked what lies across.
    CHECK(falls.effort().faces_passed <= 3 * 2 * 64 * 64 / 2);
}

TEST_CASE("rockfall falls the same on any number of threads", "[rockfall][threads]") {
    rockfall_options const options{.joints = random_cracks(5, 6, 20), .friction_angle = 20};
    auto const run = [&](auto const& threads) {
        sparse_grid g({.size = {70, 40, 65}, .spacing = {0.25, 0.25, 0.25}, .origin = {-3, 1, 0}}, up_axis::plus_z,
                      on_the_ground);
        for (std::size_t b = 0; b < g.brick_count(); ++b) {
            g.fill_brick(b, [&](voxel v) {
                stream of_cube(5, stage::user, static_cast<std::uint64_t>(v.x / 8 + 64 * (v.y / 8 + 64 * (v.z / 8))));
                return of_cube.chance(0.5) ? voxel_state::rock : voxel_state::air;
            });
        }
        rockfall fall(options);
        std::vector<voxel_change> changes;
        auto blocks = fall.fall(g, {}, 3, threads, changes);
        return std::pair{blocks, changes};
    };
    auto const one = run(inline_executor{});
    CHECK(one.first.size() > 3);
    for (std::size_t const n : {2U, 7U}) {
        thread_pool pool(n);
        CHECK(run(pool) == one);
    }
}

TEST_CASE("rockfall refuses what it cannot follow, and changes nothing", "[rockfall]") {
    CHECK_THROWS_AS(rockfall({.friction_angle = -1}), invalid_input);
    CHECK_THROWS_AS(rockfall({.friction_angle = 90}), invalid_input);
    CHECK_THROWS_AS(rockfall({.friction_angle = std::nan("")}), invalid_input);
    CHECK_THROWS_AS(rockfall({.joints = {{{.radius = -1}}}}), invalid_input);
    sparse_grid g({.size = {8, 8, 8}}, up_axis::plus_z, on_the_ground);
    fill(g, {0, 0, 0}, {7, 7, 5});
    rockfall fall;
    std::vector<voxel_change> changes;
    fall.fall(g, {}, 0, inline_executor{}, changes);
    std::vector<voxel> const rock{{1, 1, 5}};
    std::vector<voxel> const outside{{-1, 0, 0}};
    CHECK_THROWS_AS(fall.fall(g, rock, 1, inline_executor{}, changes), invalid_input);
    CHECK_THROWS_AS(fall.fall(g, outside, 1, inline_executor{}, changes), invalid_input);
    sparse_grid other({.size = {9, 8, 8}});
    CHECK_THROWS_AS(fall.fall(other, {}, 1, inline_executor{}, changes), invalid_input);
    CHECK(changes.empty());
    CHECK(remove(g, fall, {{1, 1, 5}, {1, 1, 5}}).empty());
}
