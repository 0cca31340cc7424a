/* random_blocks.c - elements that are more than one: code models of XSPICE, LTspice's A devices, derivatives and integrals
 * in formulas; and the cards of analyses around a steady state. */
#include "random_draft.h"

/* A source that is a formula of derivatives and integrals. */
static void rates(struct draft *d, int n, const char *a, const char *b) {
    put(d, "b%d %s %s %s={%s*%s(", 70 + n, a, b, WORD(d, "v", "i"), WORD(d, "1", "1u", "-1m", "1k"),
        WORD(d, "ddt", "idt", "sdt"));
    formula(d, 1);
    put(d, ")}");
}

static void varistor(struct draft *d, int n, const char *a) {
    put(d, "a%d %s %s 0 0 0 0 %s 0 VARISTOR rclamp=%s", 70 + n, live(d), node(d), a,
        WORD(d, "1", "0", "10"));
}

static void modulate(struct draft *d, int n, const char *a) {
    put(d, "a%d %s %s 0 0 0 0 %s 0 MODULATE mark=%s space=%s", 70 + n, live(d),
        WORD(d, "0", "a", "b"), a, WORD(d, "50k", "20k", "0"), WORD(d, "10k", "40k"));
}

static void transconductor(struct draft *d, int n, const char *a) {
    put(d, "a%d %s %s 0 0 0 0 %s 0 OTA g=%s iout=%s vhigh=%s vlow=%s%s%s", 70 + n, node(d), live(d),
        a, WORD(d, "1m", "1", "1u"), WORD(d, "1m", "10u", "1"), WORD(d, "5", "1e308", "1"),
        WORD(d, "-5", "0", "-1e308"), WORD(d, "", " linear"),
        WORD(d, "", " rout=1k", " cout=1n", " rout=1k cout=1n isink=2m"));
}

/* Code models of voltages: their ports are nodes, their output is a. */
static void analog(struct draft *d, int n, const char *a) {
    static const struct {
        const char *ports, *model;
    } of[] = {
        {"%s", "gain(gain=2 in_offset=0.1 out_offset=-1)"},
        {"[%s a]", "summer(in_gain=[1 -2] out_gain=0.5)"},
        {"%s", "limit(gain=3 out_lower_limit=-1 out_upper_limit=2)"},
        {"%s", "int(gain=1k out_lower_limit=-1 out_upper_limit=2 out_ic=0.5)"},
        {"%s", "d_dt(gain=1u out_lower_limit=-5 out_upper_limit=5)"},
        {"%s", "pwl(x_array=[-1 0 1 2] y_array=[0 0 1 -1])"},
        {"%s", "slew(rise_slope=1e5 fall_slope=2e5)"},
        {"%s", "hyst(in_low=0 in_high=1 hyst=0.2 out_lower_limit=-1 out_upper_limit=1)"},
        {"[%s a]", "mult(in_gain=[1 1] out_gain=0.1)"},
        {"%s a", "divide(den_offset=3)"},
        {"%s a b", "climit(gain=2 upper_delta=0.1 lower_delta=0.1)"},
        {"%s", "s_xfer(num_coeff=[1] den_coeff=[10u 1])"},
        {"%s", "triangle(cntl_array=[0 1] freq_array=[10k 40k])"},
        {"%s", "sine(cntl_array=[-1 0 5] freq_array=[0 20k 90k] out_low=0)"},
        {"%s", "square(cntl_array=[0 4] freq_array=[0 40k] duty_cycle=0.3)"},
        {"%s null null", "oneshot(cntl_array=[0 1] pw_array=[2u 9u] retrig=true)"},
    };

    const int f = pick(d, (int)(sizeof of / sizeof *of));
    const char *in = live(d);
    /* the third node is there with three */
    const bool is_there = f != 10 || d->n_nodes > 2;
    put(d, "a%d ", 70 + n);
    put(d, is_there ? of[f].ports : "%s a a", in);
    put(d, " %s x%d\n.model x%d %s", a, n, n, of[f].model);
}

/* Bits between two bridges. */
static void digital(struct draft *d, int n, const char *a) {
    static const struct {
        const char *ports, *model;
    } of[] = {{"[i%d j%d]", "d_and(rise_delay=1u fall_delay=2u)"},
              {"[i%d ~j%d]", "d_xor"},
              {"i%d j%d null null", "d_dff(clk_delay=1u)"},
              {"i%d j%d null null null", "d_jkff"},
              {"i%d j%d null null", "d_dlatch(data_delay=1u)"},
              {"i%d j%d null null null", "d_srlatch"}};

    static const char *const ends[] = {"", "", " null", " null", " null", " null"};
    const int f = pick(d, (int)(sizeof of / sizeof *of));
    const char *ports[] = {of[f].ports, "i%d i%d j%d null null"};
    put(d, "a%d [%s %s] [i%d j%d] adc%d\n.model adc%d adc_bridge(in_low=0.2 in_high=%s)\n", 100 + n,
        live(d), live(d), n, n, n, n, WORD(d, "0.8", "0.2", "3"));
    put(d, "a%d ", 130 + n);
    if (f == 3 || f == 5) { /* two data inputs and a clock */
        put(d, ports[1], n, n, n);
    } else {
        put(d, ports[0], n, n);
    }
    put(d, " q%d%s d%d\n.model d%d %s\n", n, ends[f], n, n, of[f].model);
    put(d, "a%d [q%d] [%s] dac%d\n.model dac%d dac_bridge(out_high=%s)", 160 + n, n, a, n, n,
        WORD(d, "5", "1", "0.1"));
}

void block(struct draft *d, int n, const char *a, const char *b) {
    switch (pick(d, 8)) {
    case 0:
        rates(d, n, a, b);
        break;
    case 1:
        varistor(d, n, a);
        break;
    case 2:
        modulate(d, n, a);
        break;
    case 3:
    case 4:
        transconductor(d, n, a);
        break;
    case 5:
        digital(d, n, a);
        break;
    default:
        analog(d, n, a);
        break;
    }
}

void subcircuits(struct draft *d) {
    static const char *const inner[] = {
        "d1 m q dm\n.model dm D(Ron={r} Vfwd=0.7)\nc1 m q 10n ic=1",
        "s1 m q p q sm\n.model sm SW(Vt=0.5 Vh=0.1 Ron={r/1k})\nd1 q m",
        "l1 m q 1m\nl2 s q 4m\nk1 l1 l2 0.98\nr2 s q {2*r}",
        "e1 s q m q 2\nf1 p m e1 0.1\nr2 s q {r}",
        "b1 m q i={g(v(m,q),2)}\nh1 s q e1 10\ne1 t q m q 1\nr2 s t {r}"};
    const int n = 1 + pick(d, 3);
    for (int k = 0; k < n; k++) {
        put(d, "x%d %s %s %s%s\n", k, live(d), node(d), WORD(d, "one", "two"),
            WORD(d, "", " r=47", " params: r=1"));
    }
    put(d, ".func g(x,y) {%s}\n", WORD(d, "x/(1k*y)", "1m*max(x,y)", "1m*x*y"));
    put(d, ".subckt one p q params: r=1k\nr1 p m {r}\n%s\n.ends\n", inner[pick(d, 5)]);
    put(d, ".subckt two p q r=100\nx1 p m one r={r*2}\nx2 m q one\nr1 m 0 {r}\n%s.ends\n",
        WORD(d, "", "c1 m 0 1n\n", ".ic v(m)=1\n"));
    put(d, "%s", WORD(d, "", ".temp 50\n", ".options tnom=20\n"));
}

void other_analyses(struct draft *d) {
    switch (pick(d, 5)) {
    case 0:
        put(d, ".env %s%s\n", WORD(d, "0.4m", "1m", "100u"), WORD(d, "", " uic", " tol=1e-3"));
        return;
    case 1:
        put(d, ".pss 100u\niac 0 a AC 1\n.ac lin 3 1k 20k\n.meas ac ga find vdb(a) at=%s\n",
            WORD(d, "5k", "1k"));
        break;
    case 2:
        put(d, ".pss %s\n.meas pss gp %s v(a)\n.losses\n",
            WORD(d, "100u", "auto osc", "200u osc uic"), WORD(d, "avg", "rms", "pp", "max_at"));
        break;
    case 3:
        put(d, ".losses from=%s to=%s\n", WORD(d, "0", "2u", "1u"), WORD(d, "9u", "10u"));
        break;
    default:
        put(d, ".op\n.meas op go find v(a)\n.step temp %s\n", WORD(d, "list 27 50", "0 50 25"));
        break;
    }
    put(d, ".tran 1u %s uic\n", WORD(d, "33u", "10u", "80u"));
}
