/* losses_json.h - where the power went, for programs. */
#ifndef DALCS_LOSSES_JSON_H
#define DALCS_LOSSES_JSON_H

#include "dalcs.h"
#include "json.h"

void dalcs_losses_json_write(struct dalcs_json *json, const struct dalcs_losses *losses);

#endif
