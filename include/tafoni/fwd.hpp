/// \file
/// Names without definitions, for headers of hosts that only pass our types along.
#ifndef TAFONI_FWD_HPP
#define TAFONI_FWD_HPP

#include <cstdint>

namespace tafoni {

class stream;
struct run_context;
struct inline_executor;
struct box3;
struct indexed_mesh;
struct solid;
struct shard_complex;
struct link_view;
struct water;
struct link_scale;
struct part;
struct voxel;
struct grid_frame;
class dense_grid;
class sparse_grid;
template <class Mesh>
struct mesh_access;
template <class Grid>
struct grid_access;

enum class errc : std::uint16_t;
enum class link_state : std::uint8_t;
enum class cell_state : std::uint8_t;
enum class voxel_state : std::uint8_t;

}  // namespace tafoni

#endif
