// expect: link_network
// expect: n\.for_each_neighbor\(l, f\)
#include <tafoni/graph/concepts.hpp>

struct mine {
    std::size_t cell_count() const { return 0; }
    double cell_volume(tafoni::cell_index) const { return 0; }
    std::size_t link_count() const { return 0; }
    bool has_link(tafoni::link_index) const { return false; }
    std::array<tafoni::cell_index, 2> link_cells(tafoni::link_index) const { return {}; }
    double link_area(tafoni::link_index) const { return 0; }
    tafoni::vec3 link_centroid(tafoni::link_index) const { return {0, 0, 0}; }
    tafoni::vec3 link_normal(tafoni::link_index) const { return {0, 0, 1}; }
    void for_each_cell_link(tafoni::cell_index, auto const&) const {}
#ifndef TAFONI_TEST_MISTAKE
    void for_each_neighbor(tafoni::link_index, auto const&) const {}
#endif
};

static_assert(tafoni::link_network<mine>);
