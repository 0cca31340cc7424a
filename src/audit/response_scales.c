/* response_scales.c - the largest voltages and currents, by which rounding is measured that laws carry to each other. */
#include "response_internal.h"

/* Where nothing flows, currents are what the resistors make of the rounding of voltages. */
void response_find_largest(struct dalcs_response_audit *a, const struct dalcs_response_values *is) {
    a->volts = a->amperes = 0.0;
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->volts = fmax(a->volts, response_magnitude(is->v[n]));
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        const bool is_resistor = device->kind == DALCS_RESISTOR && device->value != 0.0;
        const double of_rounding =
            is_resistor ? dalcs_rounded * a->volts / fabs(device->value) : 0.0;
        a->amperes = fmax(fmax(a->amperes, of_rounding / a->rounding),
                          is->size[d] >= 0.0 ? response_magnitude(is->i[d]) : 0.0);
    }
}

/* Derivatives of fluxes are voltages, those of charges currents; what rounding makes of them goes on to all others. */
static void add_derivatives(struct dalcs_response_audit *a, double steepness) {
    double flux = 0.0;
    double charge = 0.0;
    double drop = 0.0; /* that rounding makes of currents */
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        if (a->of.are_there[d] && device->kind == DALCS_INDUCTOR) {
            flux = fmax(flux, fabs(device->value) * a->amperes);
        } else if (a->of.are_there[d] && device->kind == DALCS_CAPACITOR) {
            charge = fmax(charge, fabs(device->value) * a->volts);
        } else if (a->of.are_there[d] && device->kind == DALCS_RESISTOR) {
            drop = fmax(drop, dalcs_rounded * fabs(device->value) * a->amperes);
        }
    }
    a->volts = fmax(a->volts, drop / a->rounding);
    a->small.of_flux = dalcs_rounded * steepness * flux;
    a->volts += steepness * flux;
    a->amperes += steepness * charge;
}

void response_find_small(struct dalcs_response_audit *a, const struct dalcs_response_values *is) {
    response_find_largest(a, is);
    a->volts = a->small.volts = fmax(a->small.volts, a->volts);
    a->amperes = a->small.amperes = fmax(a->small.amperes, a->amperes);
    add_derivatives(a, is->steepness);
}
