/* audit_text.h - which laws a file of waveforms breaks, for a person and for a program. */
#ifndef DALCS_AUDIT_TEXT_H
#define DALCS_AUDIT_TEXT_H

#include "dalcs.h"

#include <stdio.h>

/* A table, the worst first; without `all` at most a dozen of the laws that hold. Errors stay in the stream. */
void dalcs_audit_write_text(FILE *stream, const struct dalcs_table_audit *audit, const char *file,
                            bool all);

/* The whole as JSON, by doc/audit.schema.json. */
void dalcs_audit_write_json(FILE *stream, const struct dalcs_table_audit *audit, const char *file);

#endif
