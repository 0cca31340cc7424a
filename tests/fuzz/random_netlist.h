#ifndef TESTS_FUZZ_RANDOM_NETLIST_H
#define TESTS_FUZZ_RANDOM_NETLIST_H
/* random_netlist.h - bytes to a valid netlist: any bytes give one, each byte a choice. */
#include <stddef.h>
#include <stdint.h>

enum { RANDOM_NETLIST_SIZE = 8192 };

/* Writes 2 to 12 elements of any kinds on up to 6 nodes, their models and the cards of some analyses.
 * Nodes hang together, names exist, and what a card may not say it does not. Ends with a 0 byte. */
void random_netlist(const uint8_t *data, size_t size, char text[RANDOM_NETLIST_SIZE]);

#endif
