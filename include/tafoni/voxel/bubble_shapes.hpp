/// \file
/// All bubbles that are shipped.
#ifndef TAFONI_VOXEL_BUBBLE_SHAPES_HPP
#define TAFONI_VOXEL_BUBBLE_SHAPES_HPP

#include <tafoni/voxel/disc_bubble.hpp>
#include <tafoni/voxel/ellipsoid_bubble.hpp>
#include <tafoni/voxel/gumdrop_bubble.hpp>
#include <tafoni/voxel/predicate_bubble.hpp>
#include <tafoni/voxel/sphere_bubble.hpp>

#endif
