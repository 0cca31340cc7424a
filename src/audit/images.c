/* images.c - the rows of a screen times the map that gave the steps of one length. */
#include "screen.h"

#include <stdlib.h>

static void forget(struct audit_image *image) {
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        free(image->at[m].place);
    }
    *image = (struct audit_image){0};
}

/* The image of these steps, which may be new; NULL: they may not come back. */
static struct audit_image *find(struct audit_screen *screen,
                                const struct dalcs_audit_polynomials *p) {
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        struct audit_image *image = &screen->image[k];
        if (image->step == p->step && audit_is_same_end(image->end, p->end)) {
            screen->image_at = k;
            return image;
        }
    }
    const bool comes_back = screen->step == p->step && audit_is_same_end(screen->end, p->end);
    screen->step = p->step;
    screen->end = p->end;
    if (!comes_back) {
        return NULL;
    }
    screen->image_at = (screen->image_at + 1) % AUDIT_IMAGES;
    struct audit_image *image = &screen->image[screen->image_at];
    forget(image);
    image->step = p->step;
    image->end = p->end;
    return image;
}

/* To make an image takes as much as to ask as many stretches as it has inputs, whose values are there: it is made when so
 * much was spent without it (A. Karlin et al., Competitive snoopy caching, Algorithmica 3 (1988)). */
static bool is_due(const struct audit_image *image, const struct dalcs_audit_polynomials *p) {
    int n_made = 1;
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        n_made += image->at[m].place != NULL ? 1 : 0;
    }
    return image->n_asked >= (long)n_made * p->n_inputs;
}

static void compose(const struct dalcs_audit *audit, const struct audit_part *part,
                    const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                    int m, struct audit_image_at *at) {
    const struct dalcs_audit_reader *r = &audit->reader;
    for (int j = 0; j < p->n_inputs; j++) {
        const double *value = r->column(r->user, (int)(part - audit->part), j);
        double *place = at->place + j * screen->n_places;
        if (value == NULL) {
            continue;
        }
        audit_screen_place(part->watch, screen, p, m, value, place);
        for (int k = AUDIT_PLACE_SIGNS; k < screen->n_places; k++) {
            at->reach[j] = fmax(at->reach[j], fabs(place[k]));
        }
    }
    at->slack = -1.0;
}

struct audit_image_at *audit_image_of(const struct dalcs_audit *audit,
                                      const struct audit_part *part, struct audit_screen *screen,
                                      const struct dalcs_audit_polynomials *p, int m) {
    const size_t n_inputs = (size_t)p->n_inputs;
    const size_t numbers = n_inputs * ((size_t)screen->n_places + 2);
    struct audit_screens *screens = &part->watch->screens;
    struct audit_image *image = p->input != NULL ? find(screen, p) : NULL;
    struct audit_image_at *at = image != NULL ? &image->at[m] : NULL;
    if (at != NULL && at->place == NULL && is_due(image, p) &&
        screens->numbers + numbers <= AUDIT_MOST_NUMBERS) {
        at->place = dalcs_alloc(numbers, sizeof(double));
        if (at->place != NULL) {
            screens->numbers += numbers;
            at->reach = at->place + n_inputs * (size_t)screen->n_places;
            at->input = at->reach + n_inputs;
            compose(audit, part, screen, p, m, at);
        }
    }
    if (image != NULL) {
        image->n_asked++;
    }
    return at != NULL && at->place != NULL ? at : NULL;
}

void audit_images_forget(struct audit_screen *screen) {
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        forget(&screen->image[k]);
    }
}
