/* eight_bytes.h - plain text eight bytes at a time, as one number: a netlist may be a hundred megabytes.
 *
 * The tests hold for bytes below 0x80, so that no sum carries into the next byte, and put their answer
 * in the highest bit of each byte (H. S. Warren, Hacker's Delight, section 6-1). */
#ifndef DALCS_EIGHT_BYTES_H
#define DALCS_EIGHT_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

static const uint64_t DALCS_EACH_BYTE = 0x0101010101010101U;
static const uint64_t DALCS_HIGH_BITS = 0x8080808080808080U;

static inline uint64_t dalcs_eight_load(const void *p) {
    uint64_t eight;
    memcpy(&eight, p, sizeof eight);
    return eight;
}

/* Which bytes are `least` or above; least is 1 to 0x80. */
static inline uint64_t dalcs_eight_from(uint64_t eight, unsigned least) {
    return (eight + (0x80U - least) * DALCS_EACH_BYTE) & DALCS_HIGH_BITS;
}

/* Which bytes are this one. */
static inline uint64_t dalcs_eight_are(uint64_t eight, char c) {
    return dalcs_eight_from(eight ^ (unsigned char)c * DALCS_EACH_BYTE, 1) ^ DALCS_HIGH_BITS;
}

/* Printable ASCII, tabs and newlines only? */
static inline bool dalcs_eight_is_plain(uint64_t eight) {
    if ((eight & DALCS_HIGH_BITS) != 0) {
        return false;
    }
    const uint64_t is_control = ~dalcs_eight_from(eight, ' ') & DALCS_HIGH_BITS;
    const uint64_t is_space = dalcs_eight_are(eight, '\n') | dalcs_eight_are(eight, '\t');
    return (is_control & ~is_space) == 0 && dalcs_eight_from(eight, 0x7F) == 0;
}

/* Capital letters to small ones, of plain bytes. */
static inline uint64_t dalcs_eight_lower(uint64_t eight) {
    const uint64_t is_capital = dalcs_eight_from(eight, 'A') & ~dalcs_eight_from(eight, 'Z' + 1);
    return eight | is_capital >> 2; /* 0x80 >> 2 is what they differ by */
}

/* Bytes of ASCII at the start of p[0..n-1], in steps of eight. */
static inline size_t dalcs_eight_skip_ascii(const void *p, size_t n) {
    size_t k = 0;
    while (n - k >= 8 && (dalcs_eight_load((const char *)p + k) & DALCS_HIGH_BITS) == 0) {
        k += 8;
    }
    return k;
}

#endif
