/* transistor_parts.c - a small table of MOSFETs.
 *
 * The threshold and the resistance at the gate voltage that datasheets of such parts test it at, typical at 25
 * degrees to two digits, and the rated voltage. They are the usual figures, checked against no single maker's sheet:
 * where the second digit matters, a card of one's own says what it is. */
#include "transistor.h"

#include <math.h>
#include <string.h>

struct part {
    const char *name;
    double threshold, ron, at; /* V, ohm, V of the gate; of PMOS below 0 */
};

static const struct part PARTS[] = {
    {"2n7000", 2.1, 1.8, 10},   {"2n7002", 2.1, 2.0, 10},    {"bs170", 2.1, 1.2, 10},
    {"bs250", -2.0, 9, -10},    {"bss138", 1.3, 0.9, 10},    {"bss84", -1.6, 5, -10},
    {"ao3400", 1.1, 0.022, 10}, {"ao3401", -0.9, 0.05, -10}, {"irlml2502", 0.9, 0.035, 4.5},
    {"irf510", 3, 0.4, 10},     {"irf520", 3, 0.22, 10},     {"irf520n", 3, 0.16, 10},
    {"irf530", 3, 0.13, 10},    {"irf530n", 3, 0.075, 10},   {"irf540", 3, 0.06, 10},
    {"irf540n", 3, 0.044, 10},  {"irf630", 3, 0.35, 10},     {"irf640", 3, 0.15, 10},
    {"irf640n", 3, 0.13, 10},   {"irf740", 3, 0.45, 10},     {"irf840", 3, 0.75, 10},
    {"irfz44", 3, 0.024, 10},   {"irfz44n", 3, 0.015, 10},   {"irf3205", 3, 0.0065, 10},
    {"irfp250", 3, 0.075, 10},  {"irfp250n", 3, 0.065, 10},  {"irfp260", 3, 0.045, 10},
    {"irfp260n", 3, 0.035, 10}, {"irfp460", 3, 0.23, 10},    {"irlz44", 1.5, 0.022, 5},
    {"irlz44n", 1.5, 0.02, 5},  {"irl540", 1.5, 0.06, 5},    {"irf4905", -3, 0.017, -10},
    {"irf9530", -3, 0.25, -10}, {"irf9540", -3, 0.16, -10},  {"irf9540n", -3, 0.1, -10},
    {"irf9640", -3, 0.45, -10},
};

bool dalcs_transistor_part_find(const char *name, struct dalcs_transistor *transistor) {
    for (size_t k = 0; k < sizeof PARTS / sizeof PARTS[0]; k++) {
        const struct part *part = &PARTS[k];
        if (strcmp(part->name, name) == 0) {
            transistor->name = part->name;
            transistor->is_p = part->at < 0;
            transistor->threshold = part->threshold;
            transistor->ron = part->ron;
            transistor->high = part->at;
            return true;
        }
    }
    return false;
}
