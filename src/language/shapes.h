/* shapes.h - smooth formulas of one quantity that rise or fall, and where they reach a number. Private to this folder. */
#ifndef DALCS_SHAPES_H
#define DALCS_SHAPES_H

#include "kinks.h"

enum dalcs_shape_kind {
    DALCS_SHAPE_OTHER, /* or not known */
    DALCS_SHAPE_NUMBER,
    DALCS_SHAPE_RISING,
    DALCS_SHAPE_FALLING,
    DALCS_SHAPE_VALLEY, /* it falls up to the centre and rises from there */
    DALCS_SHAPE_PEAK
};

struct dalcs_shape {
    enum dalcs_shape_kind kind;
    double centre;    /* of a valley or a peak */
    double from, to;  /* before and beyond it is a number */
    double low, high; /* it has values between these */
    bool is_curved;   /* it is no line */
};

struct dalcs_shape dalcs_shape_read(const struct dalcs_kinks *kinks, const struct dalcs_formula *f);

/* The value where the quantity is at x. */
double dalcs_shape_value(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double x);

/* Where a formula that rises or falls between low and high has a value, which it passes there; NAN: nowhere. */
double dalcs_shape_reach(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double low,
                         double high, double value);

#endif
