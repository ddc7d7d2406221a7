// expect: cell_index|cell_tag
// expect: link_index|link_tag
#include <tafoni/core/index.hpp>

bool alive(tafoni::link_index);

bool ask(tafoni::cell_index cell, tafoni::link_index link) {
#ifdef TAFONI_TEST_MISTAKE
    return alive(cell);
#else
    return alive(link) && cell.valid();
#endif
}
