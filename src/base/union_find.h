/* union_find.h - which items hang together.
 *
 * Items 0..n-1 form trees by parent[n]; a root is its own parent and stands for all that hangs on
 * it. */
#ifndef DALCS_UNION_FIND_H
#define DALCS_UNION_FIND_H

#include <stdbool.h>

/* Every item on its own. */
static inline void dalcs_union_reset(int *parent, int n) {
    for (int i = 0; i < n; i++) {
        parent[i] = i;
    }
}

static inline int dalcs_union_find(int *parent, int i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* False when the two hang together already. The smaller index stays the representative: ground wins,
 * then the earlier node. */
static inline bool dalcs_union_join(int *parent, int a, int b) {
    a = dalcs_union_find(parent, a);
    b = dalcs_union_find(parent, b);
    if (a < b) {
        parent[b] = a;
    } else {
        parent[a] = b;
    }
    return a != b;
}

#endif
