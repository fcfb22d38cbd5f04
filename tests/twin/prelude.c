#include "prelude.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

jmp_buf twin_end;
i64 twin_now;
i64 twin_scan;
u8 twin_eno;
i64 twin_calls;
int twin_line;

void twin_fault(int fault, int line) {
    longjmp(twin_end, fault * 1000000 + line);
}

i64 twin_exception(int fault) {
    return fault == array_bounds ? 0x101 : fault == division_by_zero ? 0x102 : fault == out_of_range ? 0x103
         : fault == runs_already || fault == calls_too_deep ? 0x54 : 0x51;
}

void twin_enter(int runs, i64 depth, i64 levels) {
    if (twin_calls + 1 + depth > levels) twin_fault(runs ? calls_too_deep : no_end, twin_line);
}

u8* twin_reach(pointer p, i64 size, int line) {
    if (!p.lo) twin_fault(no_reference, line);
    if (p.at < p.lo || p.hi - p.at < size) twin_fault(outside_of_variable, line);
    return p.at;
}

u8 twin_is_set(const void* bytes, i64 n) {
    for (const u8* at = bytes; n > 0; --n)
        if (*at++) return 1;
    return 0;
}

i64 twin_memcpy(pointer to, pointer from, i64 n, int line) {
    u8* const first = twin_reach(to, n, line);
    memmove(first, twin_reach(from, n, line), (size_t)n);
    return n;
}

i64 twin_memset(pointer to, i64 value, i64 n, int line) {
    memset(twin_reach(to, n, line), (u8)value, (size_t)n);
    return n;
}

i64 twin_memcmp(pointer a, pointer b, i64 n, int line) {
    u8* const first = twin_reach(a, n, line);
    const int order = memcmp(first, twin_reach(b, n, line), (size_t)n);
    return order < 0 ? -1 : order > 0;
}

u64* twin_put_bytes(u64* to, const void* from, i64 n) {
    memset(to, 0, (size_t)(n + 7) / 8 * 8);
    memcpy(to, from, (size_t)n);
    return to + (n + 7) / 8;
}

static const text* as_text(const void* t) {
    return t;
}

static void put(void* to, i64 room, const char* c, i64 length) {
    if (length > room) length = room;
    ((text*)to)->length = length;
    memmove(((text*)to)->c, c, (size_t)length);
}

void twin_literal(void* to, i64 room, const char* c, i64 length) {
    put(to, room, c, length);
}

void twin_set(void* to, i64 room, const void* from) {
    put(to, room, as_text(from)->c, as_text(from)->length);
}

static i64 within(i64 value, i64 least, i64 most) {
    return value < least ? least : value > most ? most : value;
}

void twin_concat(result* to, const void* a, const void* b) {
    char joined[70000];
    const i64 first = as_text(a)->length, second = as_text(b)->length;
    memcpy(joined, as_text(a)->c, (size_t)first);
    memcpy(joined + first, as_text(b)->c, (size_t)second);
    put(to, 254, joined, first + second);
}

/* `count` characters from the one numbered `first`, from 1 on. */
void twin_mid(result* to, const void* in, i64 first, i64 count) {
    const i64 begin = within(first - 1, 0, as_text(in)->length);
    put(to, 254, as_text(in)->c + begin, within(count, 0, as_text(in)->length - begin));
}

void twin_replace(result* to, const void* in, const void* with, i64 first, i64 count) {
    char joined[140000];
    const i64 length = as_text(in)->length, middle = with ? as_text(with)->length : 0;
    const i64 begin = within(first - 1, 0, length), end = within(first - 1 + count, begin, length);
    memcpy(joined, as_text(in)->c, (size_t)begin);
    if (with) memcpy(joined + begin, as_text(with)->c, (size_t)middle);
    memcpy(joined + begin + middle, as_text(in)->c + end, (size_t)(length - end));
    put(to, 254, joined, begin + middle + length - end);
}

i64 twin_find(const void* in, const void* what) {
    const text *a = as_text(in), *b = as_text(what);
    for (i64 i = 0; b->length > 0 && i + b->length <= a->length; ++i)
        if (memcmp(a->c + i, b->c, (size_t)b->length) == 0) return i + 1;
    return 0;
}

i64 twin_compare(const void* a, const void* b) {
    const i64 first = as_text(a)->length, second = as_text(b)->length;
    const int order = memcmp(as_text(a)->c, as_text(b)->c, (size_t)(first < second ? first : second));
    return order != 0 ? order : first < second ? -1 : first > second;
}

i64 twin_clock(i64 moment) {
    const i64 day = 86400000000000;
    const i64 rest = moment % day;
    return rest < 0 ? rest + day : rest;
}

u8 twin_character(const void* from, i64 room, i64 place, int line) {
    if (place < 1 || place > room) twin_fault(array_bounds, line);
    return place > as_text(from)->length ? 0 : (u8)as_text(from)->c[place - 1];
}

/* The character behind the last one lengthens the text. */
void twin_set_character(void* to, i64 place, u8 c, i64 most, int line) {
    const int appends = place == as_text(to)->length + 1 && place <= most;
    if (!appends && (place < 1 || place > as_text(to)->length)) twin_fault(array_bounds, line);
    ((text*)to)->c[place - 1] = (char)c;
    if (appends) ((text*)to)->length = place;
    else if (!c) ((text*)to)->length = place - 1;
}

u64 twin_to_bcd(u64 value, int digits, int line) {
    char decimal[24];
    if (snprintf(decimal, sizeof decimal, "%llu", (unsigned long long)value) > digits) twin_fault(out_of_range, line);
    return strtoull(decimal, 0, 16);
}

void twin_signed(result* to, i64 value) {
    to->length = snprintf(to->c, 254, "%lld", (long long)value);
}

void twin_unsigned(result* to, u64 value) {
    to->length = snprintf(to->c, 254, "%llu", (unsigned long long)value);
}

/* The fewest digits that read back as the value, with or without an exponent, what is shorter. */
static void shortest(result* to, f64 value, int is_single) {
    if (value != value || value - value != 0) {
        to->length = snprintf(to->c, 254, "%s%s", value < 0 ? "-" : "", value != value ? "nan" : "inf");
        return;
    }
    int precision = 0;
    char scientific[40], fixed[400];
    do snprintf(scientific, sizeof scientific, "%.*e", precision, value);
    while ((is_single ? strtof(scientific, 0) : strtod(scientific, 0)) != value && precision++ < 17);
    const int exponent = atoi(strchr(scientific, 'e') + 1);
    snprintf(fixed, sizeof fixed, "%.*f", precision > exponent ? precision - exponent : 0, value);
    const char* shorter = strlen(fixed) <= strlen(scientific) ? fixed : scientific;
    put(to, 254, shorter, (i64)strlen(shorter));
}

void twin_real(result* to, f64 value) { shortest(to, value, 0); }

void twin_single(result* to, f32 value) { shortest(to, value, 1); }

static const char* digits(const char* c) {
    while (*c >= '0' && *c <= '9') ++c;
    return c;
}

i64 twin_read_integer(const void* from, int line) {
    char buffer[70000];
    memcpy(buffer, as_text(from)->c, (size_t)as_text(from)->length);
    buffer[as_text(from)->length] = 0;
    const char* first = buffer + (buffer[0] == '-');
    const char* end = digits(first);
    errno = 0;
    const i64 value = strtoll(buffer, 0, 10);
    if (end == first || end != buffer + as_text(from)->length || errno) twin_fault(out_of_range, line);
    return value;
}

f64 twin_read_real(const void* from, int line) {
    char buffer[70000];
    memcpy(buffer, as_text(from)->c, (size_t)as_text(from)->length);
    buffer[as_text(from)->length] = 0;
    const char* first = buffer + (buffer[0] == '-');
    const char* end = digits(first);
    i64 count = end - first;
    if (*end == '.') {
        const char* more = digits(end + 1);
        count += more - end - 1;
        end = more;
    }
    if (count > 0 && (*end == 'e' || *end == 'E')) {
        const char* power = end + 1 + (end[1] == '-' || end[1] == '+');
        if (digits(power) > power) end = digits(power);
    }
    const f64 value = strtod(buffer, 0);
    if (count == 0 || end != buffer + as_text(from)->length || value - value != 0) twin_fault(out_of_range, line);
    return value;
}

u64* twin_put_text(u64* to, const void* from) {
    const u64 length = (u64)as_text(from)->length, words = (length + 7) / 8;
    to[0] = length;
    if (words > 0) to[words] = 0;
    memcpy(to + 1, as_text(from)->c, length);
    return to + 1 + words;
}

/* Function blocks. */

static u8 rises(u8 now, u8* before) {
    const u8 edge = now && !*before;
    *before = now;
    return edge;
}

static i64 least(i64 a, i64 b) {
    return a < b ? a : b;
}

static i64 elapsed(i64 start, i64 pt) {
    return least(twin_now - start, pt < 0 ? 0 : pt);
}

void call_ton(struct ton* b) {
    if (!b->in) {
        b->running = b->q = 0;
        b->et = 0;
        return;
    }
    if (!b->running) b->start = twin_now, b->preset = b->pt;
    b->running = 1;
    if (b->q) return;
    b->et = elapsed(b->start, b->pt);
    b->q = twin_now - b->start >= b->pt;
}

void call_tof(struct tof* b) {
    if (b->in) {
        b->q = 1;
        b->running = 0;
        b->et = 0;
        return;
    }
    if (!b->q) return;
    if (!b->running) b->start = twin_now, b->preset = b->pt;
    b->running = 1;
    b->et = elapsed(b->start, b->pt);
    b->q = twin_now - b->start < b->pt;
}

void call_tp(struct tp* b) {
    const u8 edge = rises(b->in, &b->before);
    if (edge && !b->q) {
        b->start = twin_now;
        b->preset = b->pt;
        b->q = 1;
    }
    if (b->q) {
        b->et = elapsed(b->start, b->pt);
        b->q = twin_now - b->start < b->pt;
    }
    if (!b->q && !b->in) b->et = 0;
}

static const i64 lowest[] = {INT16_MIN, INT32_MIN, INT64_MIN, 0, 0, INT8_MIN, 0, 0};
static const i64 most[] = {INT16_MAX, INT32_MAX, INT64_MAX, UINT32_MAX,
                           INT64_MAX, INT8_MAX,  UINT8_MAX, UINT16_MAX};

static i64 loaded(i64 pv, i64 type) {
    return within(pv, lowest[type], most[type]);
}

static void count(i64* cv, int by, i64 type) {
    if (by > 0 ? *cv < most[type] : *cv > lowest[type]) *cv += by;
}

void call_ctu(struct ctu* b) {
    const u8 up = rises(b->cu, &b->cu_before);
    if (b->r) b->cv = 0;
    else if (up) count(&b->cv, 1, b->data_type);
    b->q = b->cv >= b->pv;
}

void call_ctd(struct ctd* b) {
    const u8 down = rises(b->cd, &b->cd_before);
    if (b->ld) b->cv = loaded(b->pv, b->data_type);
    else if (down) count(&b->cv, -1, b->data_type);
    b->q = b->cv <= 0;
}

void call_ctud(struct ctud* b) {
    const u8 up = rises(b->cu, &b->cu_before), down = rises(b->cd, &b->cd_before);
    if (b->r) b->cv = 0;
    else if (b->ld) b->cv = loaded(b->pv, b->data_type);
    else if (up != down) count(&b->cv, up ? 1 : -1, b->data_type);
    b->qu = b->cv >= b->pv;
    b->qd = b->cv <= 0;
}

void call_r_trig(struct r_trig* b) {
    b->q = rises(b->clk, &b->last);
}

void call_f_trig(struct f_trig* b) {
    b->q = rises(!b->clk, &b->last);
}

void call_sr(struct sr* b) {
    b->q1 = b->s1 || (!b->r && b->q1);
}

void call_rs(struct rs* b) {
    b->q1 = !b->r1 && (b->s || b->q1);
}
