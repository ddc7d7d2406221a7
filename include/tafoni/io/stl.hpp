/// \file
/// STL, both ways.
#ifndef TAFONI_IO_STL_HPP
#define TAFONI_IO_STL_HPP

#include <tafoni/io/read_stl.hpp>
#include <tafoni/io/write_stl.hpp>

#endif
