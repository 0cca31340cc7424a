/* signal_name.c - spellings. */
#include "signal_name.h"

#include "lower_case.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* What stands between the parentheses of "v(...)"; its length in *n. NULL: there are none. */
static const char *inside_of(const char *text, char letter, size_t *n) {
    const size_t length = strlen(text);
    if (text[0] != letter || text[1] != '(' || length < 4 || text[length - 1] != ')') {
        return NULL;
    }
    *n = length - 3;
    return text + 2;
}

/* The letter that says what an element is: that behind the last dot, "d" of "x1.d3". */
static char letter_of(const char *element, size_t n) {
    size_t at = 0;
    for (size_t k = 0; k < n; k++) {
        at = element[k] == '.' ? k + 1 : at;
    }
    return at < n ? element[at] : '\0';
}

static bool is_number(const char *text, size_t n) {
    size_t k = 0;
    while (k < n && text[k] >= '0' && text[k] <= '9') {
        k++;
    }
    return k == n && n > 0;
}

/* An element of a subcircuit has its letter in front once more: "v.x1.v1". */
static void name_current(const char *element, size_t n, char *name) {
    const char letter = letter_of(element, n);
    const char prefix[3] = {memchr(element, '.', n) != NULL ? letter : '\0', '.', '\0'};
    const int length = (int)n;
    if (letter != '\0' && strchr("vlehb", letter) != NULL) {
        snprintf(name, NG_NAME_SIZE, "%s%.*s#branch", prefix, length, element);
    } else {
        snprintf(name, NG_NAME_SIZE, "@%s%.*s[%s]", prefix, length, element,
                 letter == 'd' ? "id" : "i");
    }
}

void ng_signal_name(const char *signal, char name[NG_NAME_SIZE]) {
    size_t n;
    const char *inside = inside_of(signal, 'v', &n);
    if (inside != NULL && is_number(inside, n)) {
        snprintf(name, NG_NAME_SIZE, "V(%.*s)", (int)n, inside);
    } else if (inside != NULL) {
        snprintf(name, NG_NAME_SIZE, "%.*s", (int)n, inside);
    } else if ((inside = inside_of(signal, 'i', &n)) != NULL) {
        name_current(inside, n, name);
    } else if ((inside = inside_of(signal, 'p', &n)) != NULL) {
        snprintf(name, NG_NAME_SIZE, "%.*s:power", (int)n, inside);
    } else {
        snprintf(name, NG_NAME_SIZE, "%s", signal);
    }
}

/* "v.x1.v1" -> "x1.v1" */
static const char *without_letter(const char *element) {
    return element[0] != '\0' && element[1] == '.' ? element + 2 : element;
}

/* Does the text end so? It is cut off then. */
static bool cut_ending(char *text, const char *ending) {
    const size_t n = strlen(text);
    const size_t m = strlen(ending);
    const bool ends = n > m && strcmp(text + n - m, ending) == 0;
    if (ends) {
        text[n - m] = '\0';
    }
    return ends;
}

void ng_signal_of(const char *name, char signal[NG_NAME_SIZE]) {
    char low[NG_NAME_SIZE];
    size_t n = 0;
    for (const char *c = name; *c != '\0' && n + 1 < sizeof low; c++) {
        if (*c != ' ' && *c != '\t') {
            low[n++] = dalcs_lower(*c);
        }
    }
    low[n] = '\0';
    const int most = NG_NAME_SIZE - 8;
    size_t inside;
    if (inside_of(low, 'v', &inside) != NULL || inside_of(low, 'p', &inside) != NULL) {
        snprintf(signal, NG_NAME_SIZE, "%s", low);
    } else if (inside_of(low, 'i', &inside) != NULL) {
        const char *element = inside_of(low, 'i', &inside);
        snprintf(signal, NG_NAME_SIZE, "i(%s", without_letter(element));
    } else if (cut_ending(low, "#branch")) {
        snprintf(signal, NG_NAME_SIZE, "i(%.*s)", most, without_letter(low));
    } else if (cut_ending(low, ":power")) {
        snprintf(signal, NG_NAME_SIZE, "p(%.*s)", most, low);
    } else if (low[0] == '@' && (cut_ending(low, "[i]") || cut_ending(low, "[id]") ||
                                 cut_ending(low, "[current]"))) {
        snprintf(signal, NG_NAME_SIZE, "i(%.*s)", most, without_letter(low + 1));
    } else if (low[0] == '@' && cut_ending(low, "[p]")) {
        snprintf(signal, NG_NAME_SIZE, "p(%.*s)", most, without_letter(low + 1));
    } else {
        snprintf(signal, NG_NAME_SIZE, "v(%.*s)", most, low);
    }
}
