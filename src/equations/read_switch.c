/* read_switch.c - what follows the name of a switch: on=threshold off=threshold [valve=number] [closed] [direct] */
#include "reader.h"
#include "reading.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* The number of a pair among those of its system. */
static bool read_valve(struct dalcs_reader *reader, struct dalcs_pair *p) {
    double number;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "the number of a pair", &number)) {
        return false;
    }
    if (!(number >= 1 && number <= INT_MAX && number == floor(number))) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "a valve is the number of a pair: 1, 2, ...");
        return false;
    }
    p->has_valve = true;
    p->valve = (int)number - 1;
    return true;
}

bool dalcs_reading_switch(struct dalcs_reader *reader, struct dalcs_pair *p) {
    p->kind = DALCS_PAIR_SWITCH;
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *parameter = dalcs_reader_take_parameter(reader);
        if (parameter != NULL && strcmp(parameter->text, "on") == 0) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "a threshold", &p->turn_on)) {
                return false;
            }
        } else if (parameter != NULL && strcmp(parameter->text, "off") == 0) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "a threshold", &p->turn_off)) {
                return false;
            }
        } else if (parameter != NULL && strcmp(parameter->text, "valve") == 0) {
            if (!read_valve(reader, p)) {
                return false;
            }
        } else if (parameter == NULL && dalcs_reader_take_word(reader, "closed")) {
            p->initially_on = true;
        } else if (parameter == NULL && dalcs_reader_take_word(reader, "direct")) {
            p->is_direct = true;
        } else {
            reader->at -= parameter != NULL ? 2 : 0;
            dalcs_reader_unexpected(reader);
            return false;
        }
    }
    if (p->turn_off > p->turn_on) {
        dalcs_builder_error(reader->builder, reader->card->token, reader->usage,
                            "a switch cannot open above the value that closes it");
        return false;
    }
    return true;
}
