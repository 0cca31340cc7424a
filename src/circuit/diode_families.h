/* diode_families.h - diodes whose names say their current and voltage. */
#ifndef DALCS_DIODE_FAMILIES_H
#define DALCS_DIODE_FAMILIES_H

#include "diode_parts.h"

#include <stddef.h>

/* A name of n bytes in lower case, without what makers put before and behind it; false: of no known family. */
bool dalcs_diode_family_find(const char *name, size_t n, struct dalcs_diode_part *part);

#endif
