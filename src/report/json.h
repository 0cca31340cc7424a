/* json.h - a small JSON writer: numbers in the fewest digits that give back the same bits, indented, always valid. */
#ifndef DALCS_JSON_H
#define DALCS_JSON_H

#include "decimal.h"

#include <stdbool.h>
#include <stdio.h>

/* Errors stay in the stream: the caller looks at ferror() once at the end. */
struct dalcs_json {
    FILE *stream; /* borrowed */
    int depth;
    int inline_depth; /* from this depth on no line breaks; 0: none */
    bool first;       /* nothing yet at this depth */
    struct dalcs_decimal decimal;
};

void dalcs_json_init(struct dalcs_json *json, FILE *stream);

/* `key` is NULL for the outermost value and in arrays. `open` is '{' or '['; `on_one_line` writes
 * it and all within it on one line. */
void dalcs_json_open(struct dalcs_json *json, const char *key, char open, bool on_one_line);
void dalcs_json_close(struct dalcs_json *json, char close);

/* inf and nan, which JSON lacks, become strings. */
void dalcs_json_number(struct dalcs_json *json, const char *key, double value);
/* null where it is not a number */
void dalcs_json_finite(struct dalcs_json *json, const char *key, double value);
void dalcs_json_integer(struct dalcs_json *json, const char *key, long value);

void dalcs_json_boolean(struct dalcs_json *json, const char *key, bool value);

/* NULL becomes null. Bytes that are not UTF-8 become U+FFFD. */
void dalcs_json_string(struct dalcs_json *json, const char *key, const char *text);

#endif
