/// \file
/// The least types that satisfy the concepts: what compiles with these asks for nothing undocumented.
#ifndef TAFONI_TESTING_ARCHETYPES_HPP
#define TAFONI_TESTING_ARCHETYPES_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/concepts.hpp>
#include <tafoni/testing/bubble_archetypes.hpp>
#include <tafoni/testing/structure_archetypes.hpp>
#include <tafoni/testing/voxel_archetypes.hpp>

#include <span>
#include <vector>

namespace tafoni::archetypes {

namespace detail {
/// Copyable by construction only: no default constructor, no assignment, no comparison.
struct least {
    explicit least(int) {}
    least(least const&) = default;
    least& operator=(least const&) = delete;
};
}  // namespace detail

struct rain : detail::least {
    using least::least;
    [[nodiscard]] vec3 draw(stream&) const { return vec3{0, 0, -1}; }
};
struct infiltration : detail::least {
    using least::least;
    [[nodiscard]] double acceptance(link_view const&, vec3 const&) const { return 1; }
};
struct flow : detail::least {
    using least::least;
    [[nodiscard]] double weight(link_view const&, link_view const&, water const&) const { return 1; }
};
struct absorption : detail::least {
    using least::least;
    [[nodiscard]] double absorbed(link_view const&, water const&, link_scale const&) const { return 0.125; }
};
struct soaking : detail::least {
    using least::least;
    [[nodiscard]] double soak_chance(link_view const&, water const&) const { return 0; }
};
struct harm : detail::least {
    using least::least;
    [[nodiscard]] double damage(link_view const&, double w, link_scale const&) const { return w; }
};
struct breakage : detail::least {
    using least::least;
    [[nodiscard]] double break_chance(link_view const&) const { return 0; }
};
struct detachment : detail::least {
    using least::least;
    [[nodiscard]] falling decide(part const&, part const&) const { return falling::neither; }
};
struct field : detail::least {
    using least::least;
    [[nodiscard]] double operator()(vec3 const&) const { return 0.5; }
};

struct estimator : detail::least {
    using least::least;
    void operator()(surface_view const&, std::span<double> mean, tafoni::executor auto const&) const {
        for (double& h : mean) h = 0.5;
    }
};
struct heading : detail::least {
    using least::least;
    [[nodiscard]] vec3 direction(wear_point const&) const { return vec3{0, 0, -1}; }
};

/// Runs blocks in order; nothing but the two required members.
struct executor : detail::least {
    using least::least;
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        inline_executor{}.for_blocks(n, grain, f);
    }
    [[nodiscard]] std::size_t thread_count() const { return 1; }
};

/// Two cells one above the other: skin on top, a bond between, skin below.
struct network {
    network() = default;
    network(network const&) = delete;
    network& operator=(network const&) = delete;

    [[nodiscard]] std::size_t cell_count() const { return 2; }
    [[nodiscard]] double cell_volume(cell_index) const { return 1; }
    [[nodiscard]] std::size_t link_count() const { return 3; }
    [[nodiscard]] bool has_link(link_index) const { return true; }
    [[nodiscard]] std::array<cell_index, 2> link_cells(link_index l) const {
        cell_index const upper{std::uint32_t{0}};
        cell_index const lower{std::uint32_t{1}};
        if (l.value == 0) return {upper, cell_index{}};
        if (l.value == 1) return {upper, lower};
        return {lower, cell_index{}};
    }
    [[nodiscard]] double link_area(link_index) const { return 1; }
    [[nodiscard]] vec3 link_centroid(link_index l) const { return vec3{0, 0, 2.0 - l.value}; }
    [[nodiscard]] vec3 link_normal(link_index l) const { return vec3{0, 0, l.value == 0 ? 1.0 : -1.0}; }
    template <class F>
    void for_each_cell_link(cell_index c, F const& f) const {
        f(link_index{c.value});
        f(link_index{c.value + 1});
    }
    template <class F>
    void for_each_neighbor(link_index l, F const& f) const {
        if (l.value > 0) f(link_index{l.value - 1});
        if (l.value < 2) f(link_index{l.value + 1});
    }
};

static_assert(rain_policy<rain> && infiltration_policy<infiltration> && flow_policy<flow>);
static_assert(absorption_rule<absorption> && soaking_rule<soaking> && damage_rule<harm>);
static_assert(breakage_rule<breakage> && detachment_rule<detachment> && scalar_field<field>);
static_assert(curvature_estimator<estimator> && direction_policy<heading>);
static_assert(tafoni::executor<executor> && link_network<network>);

}  // namespace tafoni::archetypes

#endif
