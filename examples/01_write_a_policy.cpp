// A flow policy of one's own: water that follows the dip of bedding planes. Checked, then run.
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <cstdio>

struct bedding_flow {
    tafoni::vec3 dip{0.8, 0, -0.6};  // down the beds, unit length

    double weight(tafoni::link_view const& here, tafoni::link_view const& there, tafoni::water const&) const {
        double const along = tafoni::dot(dip, tafoni::normalized(there.centroid - here.centroid));
        return along > 0 ? along * along * (1 - there.flow_resistance()) : 0;
    }
};
static_assert(tafoni::flow_policy<bedding_flow>);

int main() {
    for (auto const& broken : tafoni::laws::flow(bedding_flow{})) {
        std::printf("broken law: %s\n", broken.c_str());
        return 1;
    }
    auto const block = tafoni::voxel_cells::from_indices({.size = {20, 20, 20}}, [](auto, auto, auto) { return true; });
    tafoni::frost_run run(block, tafoni::frost_wedging{.flow = bedding_flow{}});
    tafoni::frost_report const report = run.run({.paths = 20000});
    std::printf("%llu links broken, %llu of %zu cells fell in %llu blocks\n",
                static_cast<unsigned long long>(report.links_broken),
                static_cast<unsigned long long>(report.cells_detached), block.cell_count(),
                static_cast<unsigned long long>(report.blocks));
    return report.links_broken > 0 ? 0 : 1;
}
