/* signal_formula.c - runs the steps of a formula on a stack. */
#include "signal_formula.h"

#include <math.h>

static double power(double x, double y) {
    return x < 0.0 && floor(y / 2.0) != y / 2.0 ? (double)NAN : pow(fabs(x), y);
}

static double binary(enum dalcs_operation_code code, double x, double y) {
    switch (code) {
    case DALCS_ADD:
        return x + y;
    case DALCS_SUBTRACT:
        return x - y;
    case DALCS_MULTIPLY:
        return x * y;
    case DALCS_DIVIDE:
        return y == 0.0 ? (double)NAN : x / y;
    case DALCS_REMAINDER:
        return y == 0.0 ? (double)NAN : fmod(x, y);
    case DALCS_QUOTIENT:
        return y == 0.0 ? (double)NAN : trunc(x / y);
    case DALCS_POWER:
        return power(x, y);
    case DALCS_EQUAL:
        return x == y;
    case DALCS_UNEQUAL:
        return x != y;
    case DALCS_LESS:
        return x < y;
    case DALCS_LESS_EQUAL:
        return x <= y;
    case DALCS_GREATER:
        return x > y;
    case DALCS_GREATER_EQUAL:
        return x >= y;
    default:
        return (double)NAN;
    }
}

static double call(const struct dalcs_function *f, const double *x, int n) {
    return f->one != NULL ? f->one(x[0]) : f->two != NULL ? f->two(x[0], x[1]) : f->many(x, n);
}

static double pushed(const struct dalcs_signal_formula_step *step,
                     const struct dalcs_signal_formula_point *point) {
    switch (step->push) {
    case DALCS_PUT_SIGNAL:
        return point->signal(point, step->index, step->part);
    case DALCS_PUT_TIME:
        return point->time;
    case DALCS_PUT_RESULT:
        return point->result[step->index];
    default:
        return step->number;
    }
}

/* Is the jump taken? What is on top of the stack may go. */
static bool jumps(enum dalcs_operation_code code, double *stack, int *n) {
    if (code == DALCS_JUMP) {
        return true;
    }
    bool is_zero = stack[*n - 1] == 0.0;
    bool taken = code == DALCS_JUMP_OR ? !is_zero : is_zero;
    if (taken && code == DALCS_JUMP_OR) {
        stack[*n - 1] = 1.0;
    }
    *n -= code == DALCS_JUMP_IF_ZERO || !taken;
    return taken;
}

double dalcs_signal_formula_value(const struct dalcs_signal_formula *formula,
                                  const struct dalcs_signal_formula_point *point) {
    double stack[DALCS_SIGNAL_FORMULA_DEEPEST];
    int n = 0;
    for (int k = 0; k < formula->n; k++) {
        const struct dalcs_signal_formula_step *step = &formula->step[k];
        if (step->push == DALCS_PUT_ARGUMENT) {
            stack[n++] = stack[step->index];
            continue;
        }
        if (step->push == DALCS_PUT_DOWN) {
            stack[step->index] = stack[n - 1];
            n = step->index + 1;
            continue;
        }
        if (step->push != DALCS_PUT_NOTHING) {
            stack[n++] = pushed(step, point);
            continue;
        }
        switch (step->code) {
        case DALCS_NEGATE:
            stack[n - 1] = -stack[n - 1];
            break;
        case DALCS_NOT:
            stack[n - 1] = stack[n - 1] == 0.0;
            break;
        case DALCS_TO_LOGIC:
            stack[n - 1] = stack[n - 1] != 0.0;
            break;
        case DALCS_JUMP:
        case DALCS_JUMP_IF_ZERO:
        case DALCS_JUMP_AND:
        case DALCS_JUMP_OR:
            k += jumps(step->code, stack, &n) ? step->count - 1 : 0;
            break;
        case DALCS_CALL:
            n -= step->count;
            stack[n] = call(step->function, stack + n, step->count);
            n++;
            break;
        default:
            n--;
            stack[n - 1] = binary(step->code, stack[n - 1], stack[n]);
            break;
        }
    }
    return n > 0 && isfinite(stack[0]) ? stack[0] : (double)NAN;
}
