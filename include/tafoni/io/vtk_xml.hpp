/// \file
/// VTK XML files: polygonal data and time series.
#ifndef TAFONI_IO_VTK_XML_HPP
#define TAFONI_IO_VTK_XML_HPP

#include <tafoni/io/write_pvd.hpp>
#include <tafoni/io/write_vtp.hpp>

#endif
