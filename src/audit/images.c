/* images.c - the rows of a screen times the map that gave the steps of one length. */
#include "screen.h"

#include "quads.h"

#include <stdlib.h>

static void forget(struct audit_image *image) {
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        free(image->at[m].place);
    }
    free(image->at_node);
    *image = (struct audit_image){0};
}

static int n_ends_of(const struct audit_screen *screen) {
    return 1 + (screen->n_places - AUDIT_PLACE_SIGNS) / AUDIT_SIGN_TIMES;
}

/* Does what is at any end take less by an image than by the values? Those of a column take two products at a node where
 * what may be at an end takes one for each input. Else an image is of steps that end at one place. */
static bool has_any_end(const struct audit_screen *screen,
                        const struct dalcs_audit_polynomials *p) {
    return p->n_inputs * n_ends_of(screen) <= 2 * p->n_columns;
}

/* The image of these steps, which may be new; NULL: they may not come back. */
static struct audit_image *find(struct audit_screen *screen,
                                const struct dalcs_audit_polynomials *p) {
    const bool is_any = has_any_end(screen, p);
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        struct audit_image *image = &screen->images.of[k];
        if (image->step == p->step && (is_any || audit_is_same_end(image->end, p->end))) {
            screen->images.at = k;
            return image;
        }
    }
    const bool comes_back =
        screen->images.step == p->step && (is_any || audit_is_same_end(screen->images.end, p->end));
    screen->images.step = p->step;
    screen->images.end = p->end;
    if (!comes_back) {
        return NULL;
    }
    screen->images.at = (screen->images.at + 1) % AUDIT_IMAGES;
    struct audit_image *image = &screen->images.of[screen->images.at];
    forget(image);
    image->step = p->step;
    image->end = p->end;
    return image;
}

/* To make an image takes as much as to ask as many stretches as it has inputs, whose values are there, and what is at its
 * ends as much again: it is made when so much was spent without it (A. Karlin et al., Competitive snoopy caching,
 * Algorithmica 3 (1988)). */
static bool is_due(const struct audit_image *image, const struct dalcs_audit_polynomials *p,
                   bool is_same_end) {
    int n_made = 1 + (image->at_node != NULL || !is_same_end ? 1 : 0);
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        n_made += image->at[m].place != NULL ? 1 : 0;
    }
    return image->n_asked >= (long)n_made * p->n_inputs;
}

static void find_reach(const struct audit_screen *screen, int n_inputs, struct audit_image_at *at) {
    for (int j = 0; j < n_inputs; j++) {
        const double *place = at->place + j * screen->n_places;
        at->reach[j] = 0.0;
        for (int k = AUDIT_PLACE_SIGNS; k < screen->n_places; k++) {
            at->reach[j] = fmax(at->reach[j], fabs(place[k]));
        }
    }
    at->slack = -1.0;
}

static void compose(const struct dalcs_audit *audit, const struct audit_part *part,
                    const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                    int m, struct audit_image_at *at) {
    const struct dalcs_audit_reader *r = &audit->reader;
    for (int j = 0; j < p->n_inputs; j++) {
        const double *value = r->column(r->user, (int)(part - audit->part), j);
        if (value != NULL) {
            audit_screen_place(part->watch, screen, p, m, value, at->place + j * screen->n_places);
        }
    }
    find_reach(screen, p->n_inputs, at);
    at->end = p->end;
}

/* At an image's end stretches come to theirs again and again. */
static void end_at(const struct audit_watch *watch, const struct audit_screen *screen,
                   const struct dalcs_audit_polynomials *p, const struct audit_image *image,
                   struct audit_image_at *at) {
    double w[AUDIT_MOST_NODES];
    audit_screen_weights(watch, p, p->end, w);
    const double *from = image->at_node;
    const int n_ends = n_ends_of(screen);
    for (int j = 0; j < p->n_inputs; j++, from += p->n_nodes * image->n_ends) {
        double *place = at->place + j * screen->n_places;
        for (int e = 0; e < n_ends; e++) {
            double sum = 0.0;
            for (int k = 0; k < p->n_nodes; k++) {
                sum += w[k] * from[k * image->n_ends + e];
            }
            place[e == 0 ? AUDIT_PLACE_END : AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * e - 1] = sum;
        }
    }
    find_reach(screen, p->n_inputs, at);
    at->end = p->end;
}

static double *take_room(struct audit_screens *screens, size_t numbers) {
    double *room = screens->numbers + numbers <= AUDIT_MOST_NUMBERS
                       ? dalcs_alloc(numbers, sizeof(double))
                       : NULL;
    screens->numbers += room != NULL ? numbers : 0;
    return room;
}

/* What is at the nodes, for ends in between. */
static void compose_ends(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                         struct audit_image *image) {
    const struct dalcs_audit_reader *r = &audit->reader;
    image->n_ends = dalcs_quads_of(n_ends_of(screen));
    const int n = p->n_nodes * image->n_ends;
    image->at_node = take_room(&part->watch->screens, (size_t)p->n_inputs * (size_t)n);
    for (int j = 0; j < p->n_inputs && image->at_node != NULL; j++) {
        const double *value = r->column(r->user, (int)(part - audit->part), j);
        if (value != NULL) {
            audit_screen_ends(screen, p, value, image->n_ends,
                              image->at_node + (size_t)j * (size_t)n);
        }
    }
}

struct audit_image *audit_image_of(const struct dalcs_audit *audit, const struct audit_part *part,
                                   struct audit_screen *screen,
                                   const struct dalcs_audit_polynomials *p, int m) {
    const size_t n_inputs = (size_t)p->n_inputs;
    struct audit_image *image = p->input != NULL ? find(screen, p) : NULL;
    if (image == NULL) {
        return NULL;
    }
    struct audit_image_at *at = &image->at[m];
    const bool is_same = audit_is_same_end(image->end, p->end);
    image->end = p->end;
    image->n_asked++;
    if (at->place == NULL && is_due(image, p, is_same)) {
        at->place = take_room(&part->watch->screens, n_inputs * ((size_t)screen->n_places + 2));
        if (at->place != NULL) {
            at->reach = at->place + n_inputs * (size_t)screen->n_places;
            at->input = at->reach + n_inputs;
            compose(audit, part, screen, p, m, at);
        }
    }
    if (at->place == NULL || audit_is_same_end(at->end, p->end)) {
        return at->place != NULL ? image : NULL;
    }
    if (image->at_node == NULL) {
        compose_ends(audit, part, screen, p, image);
    }
    if (image->at_node != NULL && is_same) {
        end_at(part->watch, screen, p, image, at);
    }
    return image->at_node != NULL ? image : NULL;
}

void audit_images_forget(struct audit_screen *screen) {
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        forget(&screen->images.of[k]);
    }
}
