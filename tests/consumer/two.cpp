#include <tafoni/tafoni.hpp>

int other_unit();

int other_unit() {
    tafoni::stream random(1, tafoni::stage::user, 0);
    return random.uniform01() < 1 ? tafoni::version_major : -1;
}
