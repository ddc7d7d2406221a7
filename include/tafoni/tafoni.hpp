/// \file
/// Everything but what needs foreign libraries (interop/) and what tests policies (testing/).
/// Written by `cmake -P cmake/umbrella.cmake`; include single headers where build time counts.
#ifndef TAFONI_TAFONI_HPP
#define TAFONI_TAFONI_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/core/random_normal.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/core/sum.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/geometry/concepts.hpp>
#include <tafoni/geometry/height_grid.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/geometry/lattice.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/triangulate.hpp>
#include <tafoni/geometry/wide_int.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/io/mesh_file.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/read_obj.hpp>
#include <tafoni/percolation/concepts.hpp>
#include <tafoni/percolation/cone_rain.hpp>
#include <tafoni/percolation/directional_rain.hpp>
#include <tafoni/percolation/facing_infiltration.hpp>
#include <tafoni/percolation/gravity_flow.hpp>
#include <tafoni/rules/concepts.hpp>
#include <tafoni/rules/depletion_soaking.hpp>
#include <tafoni/rules/low_life_breakage.hpp>
#include <tafoni/rules/parameter_checks.hpp>
#include <tafoni/rules/smaller_part_falls.hpp>
#include <tafoni/rules/surface_absorption.hpp>
#include <tafoni/rules/surface_damage.hpp>
#include <tafoni/version.hpp>

#endif
