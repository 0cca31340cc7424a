/* utf8.h - text from a netlist may hold any bytes; what we write must be valid UTF-8. */
#ifndef DALCS_UTF8_H
#define DALCS_UTF8_H

#include <stddef.h>

/* Bytes of the well-formed character at `text` (NUL-terminated); 0 when it is not one. */
size_t dalcs_utf8_length(const char *text);

#endif
