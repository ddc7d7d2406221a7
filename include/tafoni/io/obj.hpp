/// \file
/// Wavefront OBJ, both ways.
#ifndef TAFONI_IO_OBJ_HPP
#define TAFONI_IO_OBJ_HPP

#include <tafoni/io/read_obj.hpp>
#include <tafoni/io/write_obj.hpp>

#endif
