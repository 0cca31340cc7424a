/* steady_json.h - states, and the periodic steady state of a report as JSON. */
#ifndef DALCS_STEADY_JSON_H
#define DALCS_STEADY_JSON_H

#include "json.h"

#include "dalcs.h"

/* `value` of each state by its name, in SI units, as an object `key`; empty where `value` is NULL. */
void dalcs_states_json_write(struct dalcs_json *json, const char *key,
                             const struct dalcs_report *report, const double *value);

/* Nothing where the report has no periodic steady state. */
void dalcs_steady_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
