/* model_cards.h - .model cards, by family; what names a model.
 * Private to this folder and to equations/, whose system files are made of the same cards. */
#ifndef DALCS_MODEL_CARDS_H
#define DALCS_MODEL_CARDS_H

#include "reader.h"

/* The model of diodes without one: its index in diode_model. */
int dalcs_diode_ideal_model(struct dalcs_builder *builder);
/* The model D where no card has it, as LTspice writes it for a diode without a part: as without parameters. */
bool dalcs_diode_take_default(struct dalcs_builder *builder, const struct dalcs_token *name,
                              struct dalcs_diode_card *card, struct dalcs_diode_model *model);
/* type: d or sidiode */
bool dalcs_diode_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                             struct dalcs_diode_card *card, struct dalcs_diode_model *model);
/* So many exponential diodes in series: one with as many times the voltage. */
void dalcs_diode_cells(struct dalcs_diode_card *card, double cells);
/* The lines of an exponential diode: its tangent at a current, for `area` of them in parallel. */
void dalcs_diode_model_map(const struct dalcs_diode_card *card, double current, double area,
                           struct dalcs_diode_model *model);
/* The same of a part that the table of diodes knows by this name, with a warning; false: it does not. */
bool dalcs_diode_take_part(struct dalcs_builder *builder, const struct dalcs_token *name,
                           struct dalcs_diode_card *card, struct dalcs_diode_model *model);
/* NULL when an error was reported; the line that it conducts on into *valve. */
struct dalcs_thyristor *dalcs_thyristor_parse_model(struct dalcs_reader *reader,
                                                    const struct dalcs_token *type,
                                                    struct dalcs_diode_model *valve);
/* type: nmos, pmos, vdmos, nigbt, npn or pnp; NULL when an error was reported */
struct dalcs_transistor *dalcs_transistor_parse_model(struct dalcs_reader *reader,
                                                      const struct dalcs_token *name,
                                                      const struct dalcs_token *type);
/* Its number; -1 when out of memory. */
int dalcs_switch_add_model(struct dalcs_builder *builder, const struct dalcs_switch_model *model);
/* type: sw, csw, vswitch or iswitch */
bool dalcs_switch_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                              struct dalcs_switch_model *model);
/* Takes the models of included files that no other card names out of what is read. */
enum dalcs_status dalcs_model_leave_unnamed(struct dalcs_builder *builder,
                                            unsigned char *class_of) DALCS_MUST_CHECK;
void dalcs_model_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Warnings about models that nothing here can use, when all elements are known. */
void dalcs_model_check(struct dalcs_builder *builder);

/* One parameter=value that a model may have. */
struct dalcs_parameter {
    const char *name;
    enum dalcs_quantity quantity;
    bool may_be_infinite;
    double value;                    /* its default, then what the card says */
    const struct dalcs_token *place; /* NULL: not on the card */
};

/* Reads all parameter=value of a model card. A name that is not among parameter[0..n-1] goes to
 * `unknown`, which may report it; it is called until it has reported one. */
bool dalcs_model_read_parameters(struct dalcs_reader *reader, struct dalcs_parameter *parameter,
                                 int n,
                                 bool (*unknown)(struct dalcs_reader *reader,
                                                 const struct dalcs_token *name));
/* The index (in diode_model or switch_model) of a model of this kind; else an error, and -1. */
int dalcs_model_find(struct dalcs_builder *builder, const struct dalcs_token *name,
                     enum dalcs_model_kind kind);
/* The same of a switch whose control is a formula, of a voltage or of a current. */
int dalcs_model_find_switch(struct dalcs_builder *builder, const struct dalcs_token *name);
/* Takes the name of a model of R, L or C (letter), if one follows: *taken is it, else it stays. False after an error. */
bool dalcs_model_take_passive(struct dalcs_reader *reader, char letter,
                              const struct dalcs_model **taken);

#endif
