/* images.c - the rows of a screen times the map that gave the steps of one length. */
#include "screen.h"

#include <stdlib.h>
#include <string.h>

/* Ends of stretches are a rounding of t apart, which is as much more in steps as these are shorter than t. */
static bool is_same_end(double a, double b) {
    return fabs(a - b) <= 0x1p-32;
}

/* The image of these steps; NULL: they are the first of that length. */
static struct audit_image *find(struct audit_screen *screen,
                                const struct dalcs_audit_polynomials *p) {
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        const int at = (screen->image_at + k) % AUDIT_IMAGES;
        struct audit_image *image = &screen->image[at];
        if (image->step == p->step && is_same_end(image->end, p->end)) {
            screen->image_at = at;
            return image;
        }
    }
    screen->image_at = (screen->image_at + 1) % AUDIT_IMAGES;
    struct audit_image *image = &screen->image[screen->image_at];
    image->step = p->step;
    image->end = p->end;
    image->made = 0;
    return NULL;
}

static bool make_room(struct audit_watch *watch, struct audit_image *image, size_t numbers) {
    if (image->place == NULL && watch->screens.numbers + numbers <= AUDIT_MOST_NUMBERS) {
        image->place = dalcs_alloc(numbers, sizeof(double));
        watch->screens.numbers += numbers;
    }
    return image->place != NULL;
}

static void compose(const struct dalcs_audit *audit, const struct audit_part *part,
                    const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                    int m, double *place) {
    const struct dalcs_audit_reader *r = &audit->reader;
    for (int j = 0; j < p->n_inputs; j++) {
        const double *value = r->column(r->user, (int)(part - audit->part), j);
        memset(place, 0, (size_t)screen->n_places * sizeof(double));
        audit_screen_place(part->watch, screen, p, m, value, place);
        place += screen->n_places;
    }
}

const struct audit_image *audit_image_of(const struct dalcs_audit *audit,
                                         const struct audit_part *part, struct audit_screen *screen,
                                         const struct dalcs_audit_polynomials *p, int m) {
    const int each = p->n_inputs * screen->n_places;
    struct audit_image *image = each > 0 ? find(screen, p) : NULL;
    if (image == NULL || !make_room(part->watch, image, AUDIT_SCREEN_TIMES * (size_t)each)) {
        return NULL;
    }
    if ((image->made & 1u << m) == 0) {
        compose(audit, part, screen, p, m, image->place + m * each);
        image->made |= 1u << m;
    }
    return image;
}

void audit_images_forget(struct audit_screen *screen) {
    for (int k = 0; k < AUDIT_IMAGES; k++) {
        free(screen->image[k].place);
        screen->image[k] = (struct audit_image){0};
    }
}
