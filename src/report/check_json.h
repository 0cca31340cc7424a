/* check_json.h - what theory says of a netlist, for programs. */
#ifndef DALCS_CHECK_JSON_H
#define DALCS_CHECK_JSON_H

#include "dalcs.h"

#include <stdio.h>

/* The whole as JSON, by doc/check.schema.json. Errors stay in the stream. */
void dalcs_check_write_json(FILE *stream, const struct dalcs_check *check);

#endif
