/* page_json.h - numbers and texts as the script of a page reads them. */
#ifndef DALCS_PAGE_JSON_H
#define DALCS_PAGE_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* n numbers in base64; exact: all bits of them, else 32 of each. */
void dalcs_page_json_column(FILE *stream, const double *value, size_t n, bool exact);

/* In quotes, with no "<" that could end the script. */
void dalcs_page_json_string(FILE *stream, const char *text);
void dalcs_page_json_number(FILE *stream, double value);

#endif
