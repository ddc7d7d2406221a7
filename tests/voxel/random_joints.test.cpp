#include <catch2/catch.hpp>

#include <tafoni/voxel/random_joints.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace tafoni;

box3 box_of(vec3 const& lo, vec3 const& hi) { return box3{lo, hi}; }

bool equal(joint_disc const& a, joint_disc const& b) {
    return a.centre == b.centre && a.normal == b.normal && a.radius == b.radius;
}

}  // namespace

TEST_CASE("a line along a family's normal meets a joint every spacing", "[random_joints]") {
    vec3 const n = normalized(vec3{1, 2, 2});
    auto const box = box_of({0, 0, 0}, {20, 30, 25});
    joint_set const joints =
        random_joints{{{.normal = n * 5.0, .spread = 0, .spacing = 0.25, .radius_min = 1, .radius_max = 4}}}(box, 3);
    double way = 0;
    double met = 0;
    stream draw(1, stage::user, 0);
    for (int line = 0; line < 400; ++line) {
        double const x = draw.uniform(4, 16);
        double const y = draw.uniform(8, 22);
        double const z = draw.uniform(8, 17);
        vec3 const p{x, y, z};
        way += 8;
        for (joint_disc const& d : joints.discs) {
            double const t = dot(n, vec3(d.centre - p));
            if (std::fabs(t) > 4) continue;
            if (length(vec3(p + t * n - d.centre)) <= d.radius) met += 1;
        }
    }
    CHECK(met / way == Approx(4.0).epsilon(0.05));
}

TEST_CASE("joints keep to the spread, the radii and the box", "[random_joints]") {
    auto const box = box_of({-1, 5, 0}, {4, 9, 3});
    joint_set const joints = random_joints{
        {{.normal = {0, 0, -2}, .spread = 12, .spacing = 0.1, .radius_min = 0.5, .radius_max = 1.5}}}(box, 9);
    REQUIRE(joints.discs.size() > 100);
    CHECK_NOTHROW(joints.validate());
    double widest = 0;
    bool centre_outside = false;
    for (joint_disc const& d : joints.discs) {
        double const angle = std::acos(-normalized(d.normal)[2]) * 180 / 3.14159265358979;
        CHECK(angle <= 12 + 1e-9);
        widest = std::max(widest, angle);
        CHECK(d.radius >= 0.5);
        CHECK(d.radius <= 1.5);
        vec3 nearest = d.centre;
        for (int k = 0; k < 3; ++k) nearest[k] = std::min(std::max(nearest[k], box.lo[k]), box.hi[k]);
        CHECK(length(vec3(nearest - d.centre)) <= d.radius * (1 + 1e-12));
        centre_outside = centre_outside || !box.contains(d.centre);
    }
    CHECK(widest > 10);
    CHECK(centre_outside);
}

TEST_CASE("a family more changes nothing about the others, another seed does", "[random_joints]") {
    auto const box = box_of({0, 0, 0}, {5, 5, 5});
    random_joints::family const steep{.normal = {1, 0, 0}, .spread = 5, .spacing = 0.5};
    random_joints::family const flat{.spacing = 0.3, .radius_max = 2};
    auto const one = random_joints{{steep}}(box, 1);
    auto const two = random_joints{{steep, flat}}(box, 1);
    auto const other = random_joints{{steep}}(box, 2);
    REQUIRE(one.discs.size() > 10);
    REQUIRE(two.discs.size() > one.discs.size());
    for (std::size_t i = 0; i < one.discs.size(); ++i) CHECK(equal(one.discs[i], two.discs[i]));
    CHECK_FALSE(equal(one.discs[0], other.discs[0]));
    CHECK(random_joints{}(box, 1).discs.empty());
}

TEST_CASE("joints that nobody can strew are refused", "[random_joints]") {
    auto const box = box_of({0, 0, 0}, {5, 5, 5});
    double const nan = std::numeric_limits<double>::quiet_NaN();
    using family = random_joints::family;
    for (family const& bad :
         {family{.normal = {0, 0, 0}}, family{.normal = {nan, 0, 0}}, family{.spread = -1}, family{.spread = 61},
          family{.spacing = 0}, family{.spacing = nan}, family{.radius_min = 0},
          family{.radius_min = 2, .radius_max = 1}, family{.spacing = 1e-9}}) {
        CHECK_THROWS_AS((random_joints{{bad}}(box, 1)), invalid_input);
    }
    CHECK_THROWS_AS((random_joints{{{}}}(box3{}, 1)), invalid_input);
}
