/* measurements.h - the results of .meas and .four as ngspice prints them. */
#ifndef DALCS_MEASUREMENTS_H
#define DALCS_MEASUREMENTS_H

#include "dalcs.h"

#include <stdio.h>

/* "name = value from= a to= b", a line each, then a table for each .four; nothing without any. */
void dalcs_measurements_write(FILE *out, const struct dalcs_report *report);

#endif
