/* branch.h - at chosen allocations a child goes on where that allocation fails, and the parent as if nothing were. */
#ifndef DALCS_TESTS_BRANCH_H
#define DALCS_TESTS_BRANCH_H

#include <stdint.h>

enum branch_way { BRANCH_GOES_ON, BRANCH_FAILS_ONCE, BRANCH_FAILS_FROM_HERE };

/* Reads the points: pairs of 64 bits, the number of an allocation and the way, in the order of the numbers. A child
 * has a folder of its own in `folder`, NUMBER.WAY. Aborts on an error. */
void branch_start(const char *points, const char *folder);

/* The way that this process takes at an allocation. In the parent all children of it have ended then. */
enum branch_way branch_at(int64_t number);

#endif
