/// \file
/// All law checks: for those who write policies, structures or executors of their own.
#ifndef TAFONI_TESTING_LAWS_HPP
#define TAFONI_TESTING_LAWS_HPP

#include <tafoni/testing/bubble_laws.hpp>
#include <tafoni/testing/curvature_laws.hpp>
#include <tafoni/testing/exchange_laws.hpp>
#include <tafoni/testing/fluid_laws.hpp>
#include <tafoni/testing/mesh_laws.hpp>
#include <tafoni/testing/policy_laws.hpp>
#include <tafoni/testing/structure_laws.hpp>
#include <tafoni/testing/voxel_laws.hpp>

#endif
