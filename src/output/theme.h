/* theme.h - the colours of pictures, on white, on black and on paper. */
#ifndef DALCS_THEME_H
#define DALCS_THEME_H

enum { DALCS_THEME_CURVES = 8 };

/* All as "#rrggbb". */
struct dalcs_theme {
    const char *name; /* "light" */
    const char *background, *text, *quiet_text, *border, *grid, *bar, *mark;
    const char *curve[DALCS_THEME_CURVES];
    const char *dash[DALCS_THEME_CURVES]; /* gnuplot's pattern, NULL: a line without gaps */
};

extern const struct dalcs_theme dalcs_theme_light, dalcs_theme_dark, dalcs_theme_print;

/* NULL where there is none of that name. */
const struct dalcs_theme *dalcs_theme_find(const char *name);

#endif
