/* method_text.h - what a component was integrated with, for people and for reports. */
#ifndef DALCS_METHOD_TEXT_H
#define DALCS_METHOD_TEXT_H

#include "dalcs.h"

#include <stdbool.h>

enum { DALCS_METHOD_TEXT_SIZE = 64 };

/* And a tolerance. */
bool dalcs_method_has_stages(const char *method);

/* "radau, 5 stages", "euler", "algebraic" */
const char *dalcs_method_text(char text[DALCS_METHOD_TEXT_SIZE],
                              const struct dalcs_component_method *component);

#endif
