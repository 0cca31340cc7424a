/* response_json.h - the response around an orbit as JSON. */
#ifndef DALCS_RESPONSE_JSON_H
#define DALCS_RESPONSE_JSON_H

#include "json.h"

#include "dalcs.h"

/* "response": of .ac behind .pss, else nothing. */
void dalcs_response_json_write(struct dalcs_json *json, const struct dalcs_report *report);

#endif
