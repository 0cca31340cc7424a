/* screen_pieces.c - screens are sums of pieces. What is the same in all modes is one piece: Kirchhoff's laws, states, and
 * branches without sides. What a diode, a switch or a pair of a formula adds on one of its sides is another. Each is made
 * once for each class of steps, so a mode that is new takes a sum of what is there. All screens share the factors that were
 * drawn, which nobody but the auditor knows. What a piece allows goes with the scales when it was made. These grow, so it
 * may be too little later: then a look is asked for that was not needed, and all pieces are made again. */
#include "screen_rows.h"

#include "quads.h"

#include <stdlib.h>
#include <string.h>

struct audit_piece {
    double now, rate; /* constants of the sum of laws, of what is integrated */
    int n_columns; /* terms of rows, with the row for a place; those of each kind are behind them */
    int n_terms
        [AUDIT_N_TERM_KINDS]; /* whose places are counted from the first of its signs and guards */
    int n_signs, n_guards;
    bool has_stimuli; /* in terms */
    struct audit_term *term;
    double *constant; /* [n_signs + n_guards] */
};

/* Of steps of one class. */
struct audit_pieces {
    struct audit_pieces *next;
    int class;
    struct audit_piece *piece; /* [n], whose `term` is NULL where it is not made yet */
};

/* ---- Made ---------------------------------------------------------------------------------------- */

void audit_pieces_forget(struct audit_watch *watch) {
    struct audit_pieces *next;
    for (struct audit_pieces *set = watch->pieces.first; set != NULL; set = next) {
        next = set->next;
        for (int k = 0; k < watch->pieces.n; k++) {
            free(set->piece[k].term);
        }
        free(set);
    }
    watch->pieces.first = NULL;
}

/* Those of a class, empty where they are new; NULL: no room. */
static struct audit_pieces *pieces_of(struct audit_watch *watch, int class) {
    struct audit_pieces *set = watch->pieces.first;
    while (set != NULL && set->class != class) {
        set = set->next;
    }
    if (set == NULL) {
        const size_t n = (size_t)watch->pieces.n;
        set = dalcs_alloc(1, sizeof(*set) + n * sizeof(struct audit_piece));
        if (set != NULL) {
            set->next = watch->pieces.first;
            set->class = class;
            set->piece = (struct audit_piece *)(set + 1);
            watch->pieces.first = set;
        }
    }
    return set;
}

static struct audit_term *put_columns(const struct audit_sums_of_laws *fill,
                                      struct audit_term *to) {
    for (int r = 0; r < AUDIT_N_ROWS; r++) {
        const struct dalcs_audit_row *row = &fill->row[r];
        for (int k = 0; k < row->n_columns; k++) {
            const int column = row->listed_column[k];
            *to++ = (struct audit_term){r, column, row->column[column]};
        }
    }
    return to;
}

/* What the rows and lists of the watch have becomes a piece. */
static bool put(struct audit_watch *watch, struct audit_piece *piece) {
    const struct audit_sums_of_laws *fill = &watch->fill;
    int n = 0;
    for (int r = 0; r < AUDIT_N_ROWS; r++) {
        n += fill->row[r].n_columns;
    }
    piece->n_columns = n;
    for (int k = 0; k < AUDIT_N_TERM_KINDS; k++) {
        piece->n_terms[k] = fill->list[k].n;
        n += fill->list[k].n;
    }
    piece->has_stimuli = n > piece->n_columns + piece->n_terms[AUDIT_TERM_COLUMN];
    const size_t n_constants = (size_t)(fill->n_signs + fill->n_guards);
    struct audit_term *to = piece->term =
        dalcs_alloc(1, ((size_t)n + 1) * sizeof(*to) + n_constants * sizeof(double));
    if (to == NULL) {
        return false;
    }
    watch->screens.numbers += 2 * (size_t)n + n_constants;
    piece->now = fill->row[AUDIT_ROW_NOW].constant;
    piece->rate = fill->row[AUDIT_ROW_FLOW].constant;
    piece->n_signs = fill->n_signs;
    piece->n_guards = fill->n_guards;
    piece->constant = (double *)(to + n + 1);
    to = put_columns(fill, to);
    for (int k = 0; k < AUDIT_N_TERM_KINDS; k++) {
        for (int i = 0; i < fill->list[k].n; i++) {
            *to++ = fill->list[k].term[i];
        }
    }
    for (int k = 0; k < fill->n_signs; k++) {
        piece->constant[k] = fill->sign[k];
    }
    for (int k = 0; k < fill->n_guards; k++) {
        piece->constant[fill->n_signs + k] = fill->guard[k];
    }
    return true;
}

static bool make(struct audit_filling *f, struct audit_piece *piece, int device, int choice,
                 enum audit_side side) {
    struct audit_sums_of_laws *fill = &f->watch->fill;
    if (piece->term != NULL) {
        return true;
    }
    audit_fill_begin(fill);
    audit_fill_side(f, device, choice, side);
    audit_fill_end(f);
    return fill->complete && put(f->watch, piece);
}

/* What rounding makes of currents is allowed at nodes and of switches: a state is read for these. */
static bool make_first(struct audit_filling *f, struct audit_pieces *set) {
    struct dalcs_audit *audit = f->audit;
    struct audit_sums_of_laws *fill = &f->watch->fill;
    if (f->s == NULL) {
        audit->state.now.side = DALCS_RIGHT;
        audit->state.now.t = f->t;
        audit->reader.read(audit->reader.user, f->index, &audit->state.now);
        audit_note_scales(audit, f->part, &audit->state.now);
        audit->budget.spent += f->part->cost;
        f->s = &audit->state.now;
    }
    audit_sum_currents(audit, f->part, f->s);
    audit_fill_begin(fill);
    audit_fill_common(f);
    audit_fill_end(f);
    bool complete = fill->complete && put(f->watch, set->piece);
    struct audit_piece *at = set->piece + 1;
    for (int k = 0; k < f->part->n_devices && complete; k++) {
        const int device = f->part->device[k];
        if (audit->circuit->device[device].kind == DALCS_SWITCH) {
            complete = make(f, at + AUDIT_OFF, device, 0, AUDIT_OFF) &&
                       make(f, at + AUDIT_ON, device, 0, AUDIT_ON);
        }
        at += AUDIT_SIDES * audit_n_choices(audit->circuit, device);
    }
    return complete;
}

/* ---- Added up ------------------------------------------------------------------------------------ */

bool audit_pieces_start(struct dalcs_audit *audit, struct audit_part *part, int n_columns) {
    struct audit_watch *watch = part->watch;
    int n_choices = 0;
    for (int k = 0; k < part->n_devices; k++) {
        n_choices += audit_n_choices(audit->circuit, part->device[k]);
    }
    watch->pieces.n = 1 + AUDIT_SIDES * n_choices;
    watch->pieces.used =
        dalcs_arena_alloc(&audit->arena, (size_t)n_choices + 1, sizeof(*watch->pieces.used));
    watch->pieces.is_read = dalcs_arena_alloc(&audit->arena, (size_t)n_columns, sizeof(double));
    return watch->pieces.used != NULL && watch->pieces.is_read != NULL;
}

/* Lists the pieces of a mode; 0: one of them cannot be made. */
static int list(struct audit_filling *f, struct audit_pieces *set) {
    struct audit_piece **used = f->watch->pieces.used;
    int n_used = 0;
    int at = 1;
    used[n_used++] = set->piece;
    bool complete = set->piece->term != NULL || make_first(f, set);
    for (int k = 0; k < f->part->n_devices && complete; k++) {
        const int device = f->part->device[k];
        const int n_choices = audit_n_choices(f->audit->circuit, device);
        for (int i = 0; i < n_choices && complete; i++, at += AUDIT_SIDES) {
            const enum audit_side side = audit_side_of(f, device, i);
            used[n_used] = set->piece + at + side;
            complete = used[n_used]->term != NULL || make(f, used[n_used], device, i, side);
            n_used++;
        }
    }
    return complete ? n_used : 0;
}

/* Room for all of them. */
static bool make_room(struct audit_watch *watch, struct audit_screen *screen, int n, int n_used) {
    int n_terms = 0;
    int n_signs = 0;
    memset(screen->n_terms, 0, sizeof screen->n_terms);
    screen->n_guards = 0;
    for (int k = 0; k < n_used; k++) {
        const struct audit_piece *piece = watch->pieces.used[k];
        n_signs += piece->n_signs;
        screen->n_guards += piece->n_guards;
        screen->n_terms[AUDIT_TERM_COLUMN] += piece->n_terms[AUDIT_TERM_COLUMN];
        for (int i = AUDIT_TERM_SIGN; i < AUDIT_N_TERM_KINDS && piece->has_stimuli; i++) {
            screen->n_terms[i] += piece->n_terms[i];
        }
    }
    for (int i = 0; i < AUDIT_N_TERM_KINDS; i++) {
        n_terms += screen->n_terms[i];
    }
    screen->n_places = dalcs_quads_of(AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * n_signs);
    const size_t numbers = (size_t)(AUDIT_N_ROWS * n + screen->n_places + screen->n_guards);
    free(screen->row);
    free(screen->term[0]);
    screen->row = dalcs_alloc(numbers, sizeof(double));
    screen->term[0] = dalcs_alloc((size_t)n_terms + 1, sizeof(**screen->term));
    if (screen->row == NULL || screen->term[0] == NULL) {
        return false;
    }
    for (int k = 1; k < AUDIT_N_TERM_KINDS; k++) {
        screen->term[k] = screen->term[k - 1] + screen->n_terms[k - 1];
    }
    watch->screens.numbers += numbers;
    return dalcs_grow(&watch->place, &watch->place_room, (size_t)screen->n_places,
                      sizeof(double)) == DALCS_OK;
}

/* Terms of one kind, whose places begin so much later; returns what is behind them. */
static const struct audit_term *add_terms(struct audit_screen *screen, enum audit_term_kind kind,
                                          const struct audit_piece *piece,
                                          const struct audit_term *term, int past) {
    struct audit_term *to = screen->term[kind] + screen->n_terms[kind];
    for (int k = 0; k < piece->n_terms[kind]; k++, term++) {
        *to++ = (struct audit_term){term->place + past, term->index, term->factor};
    }
    screen->n_terms[kind] += piece->n_terms[kind];
    return term;
}

static void add(struct audit_screen *screen, const struct audit_piece *piece, int n, int sign,
                int guard, const double *is_read) {
    const struct audit_term *term = piece->term;
    for (int k = 0; k < piece->n_columns; k++, term++) {
        screen->row[term->place * n + term->index] += term->factor * is_read[term->index];
    }
    const int past = AUDIT_SIGN_TIMES * sign;
    struct audit_term *column =
        screen->term[AUDIT_TERM_COLUMN] + screen->n_terms[AUDIT_TERM_COLUMN];
    term = add_terms(screen, AUDIT_TERM_COLUMN, piece, term, past);
    for (int k = 0; k < piece->n_terms[AUDIT_TERM_COLUMN]; k++, column++) {
        column->factor *= is_read[column->index];
    }
    if (piece->has_stimuli) {
        term = add_terms(screen, AUDIT_TERM_SIGN, piece, term, past);
        term = add_terms(screen, AUDIT_TERM_GUARD, piece, term, guard);
        term = add_terms(screen, AUDIT_TERM_LAW, piece, term, 0);
        add_terms(screen, AUDIT_TERM_FLOW, piece, term, 0);
    }
    screen->constant[AUDIT_PLACE_LAWS] += piece->now;
    screen->rate += piece->rate;
    double *constant = screen->constant + AUDIT_PLACE_SIGNS + past;
    for (int k = 0; k < piece->n_signs; k++, constant += AUDIT_SIGN_TIMES) {
        constant[0] = constant[1] = constant[2] = piece->constant[k];
    }
    for (int k = 0; k < piece->n_guards; k++) {
        screen->constant[screen->n_places + guard + k] = piece->constant[piece->n_signs + k];
    }
}

bool audit_pieces_add_up(struct audit_filling *f, struct audit_screen *screen, int class,
                         int n_columns) {
    struct audit_watch *watch = f->watch;
    const struct dalcs_audit_reader *r = &f->audit->reader;
    const int n = dalcs_quads_of(n_columns);
    struct audit_pieces *set = pieces_of(watch, class);
    const int n_used = set != NULL ? list(f, set) : 0;
    if (n_used == 0 || !make_room(watch, screen, n, n_used)) {
        return false;
    }
    r->read_columns(r->user, f->index, watch->pieces.is_read);
    memset(screen->n_terms, 0, sizeof screen->n_terms);
    screen->constant = screen->row + AUDIT_N_ROWS * n;
    screen->rate = 0.0;
    int sign = 0;
    int guard = 0;
    for (int k = 0; k < n_used; k++) {
        const struct audit_piece *piece = watch->pieces.used[k];
        add(screen, piece, n, sign, guard, watch->pieces.is_read);
        sign += piece->n_signs;
        guard += piece->n_guards;
    }
    for (int k = AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * sign; k < screen->n_places; k++) {
        screen->constant[k] = INFINITY; /* no sign behind the last */
    }
    return true;
}
