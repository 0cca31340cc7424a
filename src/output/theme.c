/* theme.c - curves have the colours of M. Okabe and K. Ito, "Color Universal Design", 2008, which
 * stay apart for colour-blind eyes. Of theirs, yellow is not seen on white nor black on black; where
 * it is left out another one stands in, and blue is lighter on black. */
#include "theme.h"

#include <stddef.h>
#include <string.h>

const struct dalcs_theme dalcs_theme_light = {
    .name = "light",
    .background = "#ffffff",
    .text = "#202124",
    .quiet_text = "#5f6368",
    .border = "#80868b",
    .grid = "#e3e6ea",
    .bar = "#3c4043",
    .mark = "#9aa0a6",
    .curve = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a52a3",
              "#5f6368"},
};

const struct dalcs_theme dalcs_theme_dark = {
    .name = "dark",
    .background = "#16181c",
    .text = "#e8eaed",
    .quiet_text = "#9aa0a6",
    .border = "#80868b",
    .grid = "#2c3036",
    .bar = "#dadce0",
    .mark = "#6b7178",
    .curve = {"#56b4e9", "#e69f00", "#00b386", "#cc79a7", "#f0e442", "#ee7733", "#a890d8",
              "#bdc1c6"},
};

/* For a printer without colours: two greys, and a pattern for each curve. */
const struct dalcs_theme dalcs_theme_print = {
    .name = "print",
    .background = "#ffffff",
    .text = "#000000",
    .quiet_text = "#404040",
    .border = "#606060",
    .grid = "#e0e0e0",
    .bar = "#404040",
    .mark = "#909090",
    .curve = {"#000000", "#808080", "#000000", "#606060", "#000000", "#808080", "#000000",
              "#606060"},
    .dash = {NULL, NULL, "(12,8)", "(12,8)", "(2,6)", "(2,6)", "(12,6,2,6)", "(12,6,2,6)"},
};

const struct dalcs_theme *dalcs_theme_find(const char *name) {
    static const struct dalcs_theme *const all[] = {&dalcs_theme_light, &dalcs_theme_dark,
                                                    &dalcs_theme_print};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (strcmp(all[i]->name, name) == 0) {
            return all[i];
        }
    }
    return NULL;
}
