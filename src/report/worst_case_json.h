/* worst_case_json.h - .wcase, for the report. */
#ifndef DALCS_WORST_CASE_JSON_H
#define DALCS_WORST_CASE_JSON_H

#include "dalcs.h"
#include "json.h"

/* "worst_case": {...}; nothing where there is none. */
void dalcs_worst_case_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
