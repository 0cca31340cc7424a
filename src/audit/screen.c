/* screen.c - the screens of a part: found by key, made, kept in a table of bounded size. */
#include "screen_rows.h"

#include "quads.h"

#include <stdlib.h>
#include <string.h>

/* A multiplier whose product spreads keys (D. E. Knuth, The Art of Computer Programming 3, sec. 6.4). */
static const uint64_t spread = 0x9e3779b97f4a7c15u;

/* The same for steps within a factor of 16: it is their exponent, but for the last two bits. */
static int class_of(double length) {
    uint64_t bits;
    memcpy(&bits, &length, sizeof bits);
    return (int)(bits >> 54);
}

/* Steps within a factor of 4 are held to the same, and all of one class. */
static bool serves(const struct audit_screen *screen, uint64_t key, double length) {
    return screen->key == key &&
           (screen->class == class_of(length) ||
            (length <= 4.0 * screen->length && screen->length <= 4.0 * length));
}

/* Where the screen of a mode and a class is, or may go (op. cit., algorithm L). */
static struct audit_screen **slot_of(const struct audit_screens *screens, uint64_t key, int class) {
    const uint64_t mask = ((uint64_t)1 << screens->log2_slots) - 1;
    uint64_t at = ((key ^ (uint64_t) class) * spread) >> (64 - screens->log2_slots);
    while (screens->slot[at] != NULL &&
           (screens->slot[at]->key != key || screens->slot[at]->class != class)) {
        at = (at + 1) & mask;
    }
    return &screens->slot[at];
}

/* That of its own class, or else of one beside it. */
static struct audit_screen *find(const struct audit_screens *screens,
                                 const struct dalcs_audit_polynomials *p) {
    static const int beside[] = {0, 1, -1};
    struct audit_screen *found = NULL;
    for (size_t k = 0; k < sizeof beside / sizeof *beside && found == NULL && screens->n > 0; k++) {
        struct audit_screen *of = *slot_of(screens, p->key, class_of(p->step) + beside[k]);
        found = of != NULL && of->is_made && serves(of, p->key, p->step) ? of : NULL;
    }
    return found;
}

struct audit_screen *audit_screen_of(const struct audit_part *part,
                                     const struct dalcs_audit_polynomials *p) {
    struct audit_screens *screens = &part->watch->screens;
    if (screens->latest == NULL || !screens->latest->is_made || screens->latest->key != p->key ||
        (screens->latest->length != p->step && !serves(screens->latest, p->key, p->step))) {
        screens->latest = find(screens, p);
    }
    return screens->latest;
}

/* At most half of the slots are taken. */
static bool grow(struct audit_screens *screens) {
    if (screens->slot != NULL && 2 * (screens->n + 1) <= 1 << screens->log2_slots) {
        return true;
    }
    struct audit_screens next = *screens;
    next.log2_slots = screens->slot != NULL ? screens->log2_slots + 1 : 3;
    next.slot = dalcs_alloc((size_t)1 << next.log2_slots, sizeof(struct audit_screen *));
    for (int k = 0; next.slot != NULL && screens->slot != NULL && k < 1 << screens->log2_slots;
         k++) {
        if (screens->slot[k] != NULL) {
            *slot_of(&next, screens->slot[k]->key, screens->slot[k]->class) = screens->slot[k];
        }
    }
    if (next.slot == NULL) {
        return false;
    }
    free(screens->slot);
    *screens = next;
    return true;
}

static void drop(struct audit_screen *screen) {
    if (screen != NULL) {
        audit_images_forget(screen);
        free(screen->row);
        free(screen->term[0]);
    }
    free(screen);
}

static void drop_all(struct audit_screens *screens) {
    for (int k = 0; screens->slot != NULL && k < 1 << screens->log2_slots; k++) {
        drop(screens->slot[k]);
        screens->slot[k] = NULL;
    }
    screens->n = 0;
    screens->numbers = 0;
    screens->latest = NULL;
}

/* The screen of such steps, which need not be made. Where there is no room for more all begin anew. */
static struct audit_screen *take(struct audit_watch *watch,
                                 const struct dalcs_audit_polynomials *p) {
    struct audit_screens *screens = &watch->screens;
    if (screens->numbers > AUDIT_MOST_NUMBERS) {
        drop_all(screens);
        memset(watch->lane, 0, sizeof watch->lane);
        audit_pieces_forget(watch);
    }
    if (!grow(screens)) {
        return NULL;
    }
    struct audit_screen *other = find(screens, p);
    if (other != NULL) {
        return other;
    }
    struct audit_screen **slot = slot_of(screens, p->key, class_of(p->step));
    if (*slot == NULL) {
        *slot = dalcs_alloc(1, sizeof(**slot));
        if (*slot != NULL) {
            screens->n++;
            (*slot)->key = p->key;
            (*slot)->length = p->step;
            (*slot)->class = class_of(p->step);
            (*slot)->limit = 1.0;
        }
    }
    return *slot;
}

static void find_barycentric(const struct dalcs_audit_polynomials *p, double *barycentric) {
    for (int k = 0; k < p->n_nodes; k++) {
        double product = 1.0;
        for (int i = 0; i < p->n_nodes; i++) {
            product *= i != k ? p->node[k] - p->node[i] : 1.0;
        }
        barycentric[k] = 1.0 / product;
    }
}

double audit_screen_weight(struct dalcs_audit *audit) {
    const double draw = 2.0 * audit_draw(audit) - 1.0;
    return draw < 0.0 ? 0.5 * (draw - 1.0) : 0.5 * (draw + 1.0);
}

static bool start_row(struct dalcs_audit *audit, struct dalcs_audit_row *row, int n_columns) {
    const size_t n_stimuli = (size_t)audit->circuit->n_stimuli;
    const size_t n = (size_t)n_columns;
    row->column = dalcs_arena_alloc(&audit->arena, n, sizeof(double));
    row->listed_column = dalcs_arena_alloc(&audit->arena, n, sizeof(int));
    row->has_column = dalcs_arena_alloc(&audit->arena, n, sizeof(bool));
    row->stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(double));
    row->listed_stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(int));
    row->has_stimulus = dalcs_arena_alloc(&audit->arena, n_stimuli, sizeof(bool));
    return row->column != NULL && row->listed_column != NULL && row->has_column != NULL &&
           row->stimulus != NULL && row->listed_stimulus != NULL && row->has_stimulus != NULL;
}

/* How much of the state of a device is nothing; 0: it has none, or one that sources set. */
static double allowed_of_state(const struct dalcs_audit *audit, const struct audit_part *part,
                               int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->kind == DALCS_INDUCTOR) {
        return part->tolerance * audit_amperes(audit, part, device) + audit->options.abstol;
    }
    const bool is_held = audit->net.is_held[d->node[0]] && audit->net.is_held[d->node[1]];
    return d->kind == DALCS_CAPACITOR && !is_held
               ? part->tolerance * audit_volts(audit, part, d->node[0], d->node[1]) +
                     audit->options.vntol
               : 0.0;
}

/* How the state of a coil or a capacitor goes into the sum of states. */
static void draw_states(struct dalcs_audit *audit, const struct audit_part *part,
                        struct audit_watch *watch) {
    for (int k = 0; k < part->n_devices; k++) {
        const double allowed = allowed_of_state(audit, part, part->device[k]);
        watch->state_factor[k] = allowed > 0.0 ? audit_screen_weight(audit) / allowed : 0.0;
    }
}

void audit_screen_rescale(struct dalcs_audit *audit, struct audit_part *part) {
    struct audit_watch *watch = part->watch;
    bool has_grown = false;
    for (int k = 0; k < part->n_devices && watch->state_factor != NULL; k++) {
        const double allowed = allowed_of_state(audit, part, part->device[k]);
        has_grown |= allowed * fabs(watch->state_factor[k]) > 1.0; /* than any that is drawn */
    }
    if (!has_grown) {
        return;
    }
    draw_states(audit, part, watch);
    audit_pieces_forget(watch);
    for (int k = 0; watch->screens.slot != NULL && k < 1 << watch->screens.log2_slots; k++) {
        if (watch->screens.slot[k] != NULL) {
            watch->screens.slot[k]->is_made = false;
        }
    }
    watch->before.knows_states = false;
}

/* What all screens of a part share, when the first of them is made. */
static bool start(struct dalcs_audit *audit, struct audit_part *part,
                  const struct dalcs_audit_polynomials *p) {
    if (p->n_nodes > AUDIT_MOST_NODES) {
        return false;
    }
    struct audit_watch *watch = part->watch;
    struct audit_sums_of_laws *fill = &watch->fill;
    const size_t n_columns = (size_t)dalcs_quads_of(p->n_columns);
    watch->column = dalcs_arena_alloc(&audit->arena, 2 * n_columns, sizeof(double));
    fill->node_weight =
        dalcs_arena_alloc(&audit->arena, 2 * (size_t)audit->circuit->n_nodes, sizeof(double));
    bool complete = watch->column != NULL && fill->node_weight != NULL;
    for (int k = 0; k <= AUDIT_N_ROWS && complete; k++) {
        complete = start_row(audit, &fill->row[k], p->n_columns);
    }
    double *factor = dalcs_arena_alloc(&audit->arena, (size_t)part->n_devices, sizeof(double));
    if (!complete || factor == NULL || !audit_pieces_start(audit, part, p->n_columns)) {
        return false;
    }
    watch->state_factor = factor;
    draw_states(audit, part, watch);
    find_barycentric(p, watch->times.barycentric);
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        watch->times.theta[m] = (m + audit_draw(audit)) / AUDIT_SCREEN_TIMES;
    }
    return true;
}

void audit_screen_finish(struct audit_part *part) {
    struct audit_watch *watch = part->watch;
    if (watch == NULL) {
        return;
    }
    drop_all(&watch->screens);
    free(watch->screens.slot);
    free(watch->place);
    free(watch->batch.gathered.input);
    free(watch->fill.sign);
    free(watch->fill.guard);
    audit_pieces_forget(watch);
    for (int k = 0; k < AUDIT_N_TERM_KINDS; k++) {
        free(watch->fill.list[k].term);
    }
}

struct audit_screen *audit_screen_make(struct dalcs_audit *audit, struct audit_part *part,
                                       const struct dalcs_audit_polynomials *p,
                                       const struct dalcs_audit_state *s, double t) {
    struct audit_watch *watch = part->watch;
    if (watch->state_factor == NULL && !start(audit, part, p)) {
        return NULL;
    }
    struct audit_screen *screen = take(watch, p);
    if (screen == NULL) {
        return NULL;
    }
    struct audit_filling f = {.audit = audit,
                              .part = part,
                              .watch = watch,
                              .s = s,
                              .index = (int)(part - audit->part),
                              .step = screen->length,
                              .t = t};
    screen->rests = 0;
    screen->course.from = INFINITY;
    screen->waves.n = 0;
    screen->waves.offset = 0.0;
    for (int k = 0; k < AUDIT_WINDOWS; k++) {
        screen->window[k] = (struct audit_window){.from = INFINITY};
    }
    audit_images_forget(screen);
    screen->is_made = audit_pieces_add_up(&f, screen, screen->class, p->n_columns);
    return screen->is_made ? screen : NULL;
}
