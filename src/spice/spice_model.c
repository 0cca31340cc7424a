/* spice_model.c - the models of diodes and switches for ngspice. */
#include "spice.h"

#include <math.h>

void dalcs_spice_write_value(FILE *stream, const char *before, double value) {
    fputs(before, stream);
    dalcs_spice_write_number(stream, value);
}

void dalcs_spice_write_diode_model(FILE *stream, const struct dalcs_circuit *circuit,
                                   const struct dalcs_spice_options *o, int k) {
    const struct dalcs_diode_model *model = &circuit->models.of_diode[k];
    switch (o->diode) {
    case DALCS_SPICE_STOCK:
        fprintf(stream, ".model m__%d d", k);
        if (isfinite(model->vrev)) {
            dalcs_spice_write_value(stream, "(bv=", model->vrev);
            fputc(')', stream);
        }
        fputc('\n', stream);
        break;
    case DALCS_SPICE_EXPONENTIAL:
        for (int back = 0; back < (isfinite(model->vrev) ? 2 : 1); back++) {
            fprintf(stream, ".model m%s__%d d(is=1e-14", back ? "b" : "", k);
            dalcs_spice_write_value(stream, " n=", o->emission);
            dalcs_spice_write_value(stream,
                                    " rs=", fmax(back ? model->rrev : model->ron, o->series));
            fputs(")\n", stream);
        }
        break;
    case DALCS_SPICE_LINES:
        fprintf(stream, ".model m__%d sidiode(", k);
        dalcs_spice_write_value(stream, "ron=", fmax(model->ron, o->on));
        dalcs_spice_write_value(stream, " roff=", fmin(model->roff, o->off));
        dalcs_spice_write_value(stream, " vfwd=", model->vfwd);
        if (isfinite(model->vrev)) {
            dalcs_spice_write_value(stream, " vrev=", model->vrev);
            dalcs_spice_write_value(stream, " rrev=", fmax(model->rrev, o->on));
        }
        fputs(")\n", stream);
        break;
    }
}

void dalcs_spice_write_switch_model(FILE *stream, const struct dalcs_circuit *circuit,
                                    const struct dalcs_spice_options *o, int k) {
    const struct dalcs_switch_model *model = &circuit->models.of_switch[k];
    for (int by_current = 0; by_current < 2; by_current++) {
        fprintf(stream, by_current ? ".model mw__%d csw(" : ".model ms__%d sw(", k);
        dalcs_spice_write_value(stream, "ron=", model->ron > 0.0 ? model->ron : o->on);
        dalcs_spice_write_value(stream, " roff=", fmin(model->roff, o->off));
        dalcs_spice_write_value(stream, by_current ? " it=" : " vt=", model->vt);
        dalcs_spice_write_value(stream, by_current ? " ih=" : " vh=", model->vh);
        fputs(")\n", stream);
    }
}
