/* failed_steps_json.h - the steps of .step that failed, for the report. */
#ifndef DALCS_FAILED_STEPS_JSON_H
#define DALCS_FAILED_STEPS_JSON_H

#include "json.h"

#include "dalcs.h"

/* Nothing where there are none. */
void dalcs_failed_steps_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
