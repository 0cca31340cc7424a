/* screen_rows.h - what the files that fill the rows of a screen share. */
#ifndef DALCS_AUDIT_SCREEN_ROWS_H
#define DALCS_AUDIT_SCREEN_ROWS_H

#include "screen.h"

struct audit_filling {
    struct dalcs_audit *audit;
    struct audit_part *part;
    struct audit_watch *watch;
    const struct dalcs_audit_state *s; /* of the mode; NULL: it is not read yet */
    int index;                         /* of the part */
    double step, t;                    /* s; a time in the stretch */
};

/* The sum of laws at one time. */
static inline struct dalcs_audit_row *audit_row_now(const struct audit_filling *f) {
    return &f->watch->fill.row[AUDIT_ROW_NOW];
}

/* The factor of a law of which so much is allowed. */
static inline double audit_over(const struct audit_filling *f, double allowed) {
    return audit_screen_weight(f->audit) / fmax(allowed, 0x1p-500);
}

/* Of a branch, or between the two nodes that control it. */
void audit_add_voltage(const struct audit_filling *f, struct dalcs_audit_row *row,
                       const struct dalcs_device *d, int first, double factor);
void audit_add_read_current(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                            double factor);
void audit_add_affine(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                      const struct dalcs_affine *a, double factor);

/* value / allowed >= -1, of the row for signs, which is empty thereafter. */
void audit_put_sign(struct audit_filling *f);

/* The rows and lists of the watch become empty; what they have is listed. */
void audit_fill_begin(struct audit_sums_of_laws *fill);
void audit_fill_end(struct audit_filling *f);

/* Kirchhoff's laws, states, and branches that have no sides. */
void audit_fill_common(struct audit_filling *f);

/* screen_branches.c: the law of a device that is not Kirchhoff's, but for what it has on one of its sides only. */
void audit_fill_branch(struct audit_filling *f, int device);

/* A diode conducts, blocks or breaks down; a switch is closed or open; each pair of a formula is on one of two sides. */
enum audit_side { AUDIT_OFF, AUDIT_ON, AUDIT_IN_BREAKDOWN, AUDIT_SIDES };

/* How many times a device is on one of several sides, and on which it is in the present mode. */
int audit_n_choices(const struct dalcs_circuit *circuit, int device);
enum audit_side audit_side_of(const struct audit_filling *f, int device, int choice);

/* The law of that side, and its signs. */
void audit_fill_side(struct audit_filling *f, int device, int choice, enum audit_side side);

/* screen_pieces.c: what screens are sums of; false: no room. */
bool audit_pieces_start(struct dalcs_audit *audit, struct audit_part *part, int n_columns);

/* The rows of the screen of the present mode; false: no room, or it cannot be made. */
bool audit_pieces_add_up(struct audit_filling *f, struct audit_screen *screen, int class,
                         int n_columns);

#endif
