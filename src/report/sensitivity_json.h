/* sensitivity_json.h - .sens, for the report. */
#ifndef DALCS_SENSITIVITY_JSON_H
#define DALCS_SENSITIVITY_JSON_H

#include "dalcs.h"
#include "json.h"

/* "sensitivity": {...}; nothing where there is none. */
void dalcs_sensitivity_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
