// --core and --air SPEC: which cells are marked before the first path.
#pragma once

#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/graph/link_graph.hpp>

#include <string>
#include <vector>

namespace weather {

/// The cells that `text` names. Names: none, all, plane, box, bottom, exterior, exterior-except,
/// artificial, file. Cells count by their centroid. `option` is named in messages.
std::vector<tafoni::cell_index> choose_cells(std::string const& option, std::string const& text,
                                             tafoni::shard_complex const& shards, tafoni::link_graph const& links,
                                             tafoni::vec3 const& up);

}  // namespace weather
