/* slips.c - cards that are not where or how they should be: in the title, or without their dot. */
#include "slips.h"

#include "number.h"

#include <string.h>
#include <strings.h>

/* tran for .tran. Elements may be called as cards are, Dc and Env: it is a card if nothing follows its name, or if its name
 * is unusual for an element. */
bool dalcs_slip_lacks_dot(const struct dalcs_card *card) {
    static const char *const cards[] = {"tran",  "param",   "params", "plot",    "print",
                                        "probe", "temp",    "model",  "include", "measure",
                                        "meas",  "options", "option", "subckt",  "control"};
    static const char *const alone[] = {"end", "ends", "endc", "op"};
    const char *name = card->token->text;
    return dalcs_builder_is_one_of(name, cards, sizeof cards / sizeof cards[0]) ||
           (card->n == 1 && dalcs_builder_is_one_of(name, alone, sizeof alone / sizeof alone[0]));
}

/* Word number `index` of a line, as a NUL-terminated copy of at most `size` - 1 bytes. */
static void copy_word(const char *line, int index, char *word, size_t size) {
    const char *blank = " \t";
    const char *p = line + strspn(line, blank);
    for (; index > 0; index--) {
        p += strcspn(p, blank);
        p += strspn(p, blank);
    }
    size_t n = strcspn(p, blank);
    n = n < size - 1 ? n : size - 1;
    memcpy(word, p, n);
    word[n] = '\0';
}

/* DC, AC or a function, with or without its parenthesis. */
static bool begins_source(const char *word) {
    static const char *const known[] = {"sin", "pulse", "pwl", "exp", "am", "sffm", "dc", "ac"};
    const size_t length = strcspn(word, "(");
    bool found = false;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        found = found || (strlen(known[k]) == length && strncasecmp(word, known[k], length) == 0);
    }
    return found;
}

void dalcs_slip_check_title(struct dalcs_builder *builder) {
    const struct dalcs_source_line *line = builder->netlist->title_line;
    char first[32];
    char value[32];
    struct dalcs_number number;
    if (line == NULL) {
        return;
    }
    copy_word(line->text, 0, first, sizeof first);
    copy_word(line->text, 3, value, sizeof value);
    /* A digit distinguishes R1 from Rectifier. */
    const bool is_element =
        first[0] != '\0' && strchr("RLCVIrlcvi", first[0]) != NULL &&
        strpbrk(first, "0123456789") != NULL &&
        (dalcs_number_parse(value, &number) == DALCS_NUMBER_OK || begins_source(value));
    const bool is_card = first[0] == '.' && first[1] >= 'A' && strcasecmp(first, ".title") != 0;
    if (is_element || is_card) {
        const struct dalcs_token token = {.line = line, .length = (int)strlen(line->text)};
        dalcs_builder_warn(builder, &token, "put a title before it",
                           "the first line is always the title, though it looks like a card");
    }
}
