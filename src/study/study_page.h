/* study_page.h - a page of HTML that needs nothing else: looks, tables, figures. */
#ifndef DALCS_STUDY_PAGE_H
#define DALCS_STUDY_PAGE_H

#include <stdio.h>

/* Errors stay in the stream. */
void dalcs_page_begin(FILE *page, const char *title);
void dalcs_page_end(FILE *page);

/* Text that may hold anything. */
void dalcs_page_text(FILE *page, const char *text);

/* A file as it is, in a frame; nothing when it cannot be read. */
void dalcs_page_file(FILE *page, const char *title, const char *path);

/* "1.2e-05" as a cell; "inf" where there is no number. */
void dalcs_page_error_cell(FILE *page, double error);

/* "1.2 ms" */
void dalcs_page_quantity_cell(FILE *page, double value, const char *unit);

#endif
