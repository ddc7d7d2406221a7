/// \file
/// PLY, both ways.
#ifndef TAFONI_IO_PLY_HPP
#define TAFONI_IO_PLY_HPP

#include <tafoni/io/read_ply.hpp>
#include <tafoni/io/write_ply.hpp>

#endif
