/* measurements_json.h - the results of measurements and Fourier analyses, for programs. */
#ifndef DALCS_MEASUREMENTS_JSON_H
#define DALCS_MEASUREMENTS_JSON_H

#include "dalcs.h"
#include "json.h"

void dalcs_measurements_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
