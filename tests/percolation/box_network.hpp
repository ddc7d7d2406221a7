/// \file
/// A box of unit cubes as a stored link network: small, regular, and independent of the library's own.
#ifndef TAFONI_TESTS_PERCOLATION_BOX_NETWORK_HPP
#define TAFONI_TESTS_PERCOLATION_BOX_NETWORK_HPP

#include <tafoni/graph/concepts.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace tafoni_test {

struct box_network {
    struct link {
        std::array<tafoni::cell_index, 2> cells;
        tafoni::vec3 centroid;
        tafoni::vec3 normal;
        double area = 1;
    };
    std::vector<link> links{};
    std::vector<std::vector<tafoni::link_index>> of_cell{};
    std::vector<std::vector<tafoni::link_index>> neighbors{};
    std::vector<double> volumes{};
    std::array<int, 3> size{};

    box_network(int nx, int ny, int nz) : size{nx, ny, nz} {
        using namespace tafoni;
        volumes.assign(static_cast<std::size_t>(nx * ny * nz), 1.0);
        of_cell.resize(volumes.size());
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x)
                    for (int axis = 0; axis < 3; ++axis)
                        for (int sign = -1; sign <= 1; sign += 2) add_face({x, y, z}, axis, sign);
        neighbors.resize(links.size());
        for (std::size_t i = 0; i < links.size(); ++i) {
            for (cell_index const c : links[i].cells) {
                if (!c.valid()) continue;
                for (link_index const m : of_cell[c.value]) {
                    if (m.value != i && std::fabs(dot(links[i].normal, links[m.value].normal)) < 0.5) {
                        neighbors[i].push_back(m);
                    }
                }
            }
        }
    }

    [[nodiscard]] tafoni::cell_index at(int x, int y, int z) const {
        return tafoni::cell_index{static_cast<std::uint32_t>((z * size[1] + y) * size[0] + x)};
    }
    /// The link whose centroid is nearest to p.
    [[nodiscard]] tafoni::link_index near_to(tafoni::vec3 const& p) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < links.size(); ++i) {
            if (tafoni::length(links[i].centroid - p) < tafoni::length(links[best].centroid - p)) best = i;
        }
        return tafoni::link_index{best};
    }

    [[nodiscard]] std::size_t cell_count() const { return volumes.size(); }
    [[nodiscard]] double cell_volume(tafoni::cell_index c) const { return volumes[c.value]; }
    [[nodiscard]] std::size_t link_count() const { return links.size(); }
    [[nodiscard]] bool has_link(tafoni::link_index l) const { return l.value < links.size(); }
    [[nodiscard]] std::array<tafoni::cell_index, 2> link_cells(tafoni::link_index l) const { return links[l.value].cells; }
    [[nodiscard]] double link_area(tafoni::link_index l) const { return links[l.value].area; }
    [[nodiscard]] tafoni::vec3 link_centroid(tafoni::link_index l) const { return links[l.value].centroid; }
    [[nodiscard]] tafoni::vec3 link_normal(tafoni::link_index l) const { return links[l.value].normal; }
    template <class F>
    void for_each_cell_link(tafoni::cell_index c, F const& f) const {
        for (auto const l : of_cell[c.value]) f(l);
    }
    template <class F>
    void for_each_neighbor(tafoni::link_index l, F const& f) const {
        for (auto const m : neighbors[l.value]) f(m);
    }

private:
    void add_face(std::array<int, 3> p, int axis, int sign) {
        using namespace tafoni;
        std::array<int, 3> q = p;
        auto const a = static_cast<std::size_t>(axis);
        q[a] += sign;
        vec3 centre{p[0] + 0.5, p[1] + 0.5, p[2] + 0.5};
        centre[axis] += 0.5 * sign;
        vec3 normal{0, 0, 0};
        normal[axis] = sign;
        bool const outside = q[a] < 0 || q[a] >= size[a];
        if (!outside && sign < 0) return;
        cell_index const front = at(p[0], p[1], p[2]);
        cell_index const back = outside ? cell_index{} : at(q[0], q[1], q[2]);
        link_index const l{links.size()};
        links.push_back({{front, back}, centre, normal, 1.0});
        of_cell[front.value].push_back(l);
        if (back.valid()) of_cell[back.value].push_back(l);
    }
};

static_assert(tafoni::link_network<box_network>);

/// Pearson's chi-square against its critical value at alpha = 1e-6 (Wilson and Hilferty's approximation).
inline bool chi_square_passes(std::vector<double> const& observed, std::vector<double> const& expected) {
    double x = 0;
    double degrees = -1;
    for (std::size_t k = 0; k < observed.size(); ++k) {
        if (expected[k] == 0) {
            if (observed[k] != 0) return false;
            continue;
        }
        x += (observed[k] - expected[k]) * (observed[k] - expected[k]) / expected[k];
        degrees += 1;
    }
    if (degrees < 1) return true;
    double const h = 2 / (9 * degrees);
    double const critical = degrees * std::pow(1 - h + 4.753 * std::sqrt(h), 3);
    return x < critical;
}

}  // namespace tafoni_test

#endif
