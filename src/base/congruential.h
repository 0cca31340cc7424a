/* congruential.h - numbers that look drawn and repeat with their seed (Knuth, The Art of Computer Programming 2, 3.3.4). */
#ifndef DALCS_CONGRUENTIAL_H
#define DALCS_CONGRUENTIAL_H

#include <stdint.h>

/* The next state, of which the upper bits are good. */
static inline uint64_t dalcs_congruential_next(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return *seed;
}

/* 0 <= chance < 1 */
static inline double dalcs_congruential_chance(uint64_t *seed) {
    return (double)(dalcs_congruential_next(seed) >> 11) * 0x1p-53;
}

#endif
