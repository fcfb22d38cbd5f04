/* What the C of twin.cpp's programs is written with: types, faults, texts, the standard's function blocks. */
#include <math.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

/* So that bytes of one variable may be those of another; structs have no holes for it. */
#define ANYWHERE __attribute__((aligned(1)))

typedef int8_t i8;
typedef int16_t i16 ANYWHERE;
typedef int32_t i32 ANYWHERE;
typedef int64_t i64 ANYWHERE;
typedef uint8_t u8;
typedef uint16_t u16 ANYWHERE;
typedef uint32_t u32 ANYWHERE;
typedef uint64_t u64 ANYWHERE;
typedef float f32 ANYWHERE;
typedef double f64 ANYWHERE;
typedef __int128 i128;

/* Of what need not be fast, so that compiling it is. */
#define COLD __attribute__((cold, noinline))

enum { array_bounds = 1, division_by_zero, out_of_range, no_reference, no_end, runs_already, outside_of_variable,
    calls_too_deep = 10 };

extern jmp_buf twin_end;
extern i64 twin_now;
extern i64 twin_scan; /* its number, from 1 on */
extern u8 twin_eno; /* of the routine that ended last */
extern i64 twin_calls; /* that run */
extern int twin_line; /* of the last call that an instance finds */
void twin_fault(int fault, int line) __attribute__((noreturn));
i64 twin_exception(int fault);
/* Of what an instance has found: so many levels are there, and so many are below it. */
void twin_enter(int runs, i64 depth, i64 levels);

/* An instance of a block that others may stand for: which one it is. */
typedef struct { i64 kind; } block;

/* A byte of a variable, and all bytes of that; `lo` is 0 of what refers to nothing. */
typedef struct { u8 *at, *lo, *hi; } pointer;
u8* twin_reach(pointer p, i64 size, int line);
u8 twin_is_set(const void* bytes, i64 n); /* not all are 0 */
i64 twin_memcpy(pointer to, pointer from, i64 n, int line);
#define twin_memmove twin_memcpy
i64 twin_memset(pointer to, i64 value, i64 n, int line);
i64 twin_memcmp(pointer a, pointer b, i64 n, int line);

/* Texts: any struct that begins so. `room` is how many characters it holds; results hold 254. */
typedef struct { i64 length; char c[]; } text;
typedef struct { i64 length; char c[256]; } result;
void twin_set(void* to, i64 room, const void* from);
void twin_literal(void* to, i64 room, const char* c, i64 length);
void twin_concat(result* to, const void* a, const void* b);
void twin_mid(result* to, const void* in, i64 first, i64 count);
void twin_replace(result* to, const void* in, const void* with, i64 first, i64 count);
i64 twin_find(const void* in, const void* what);
i64 twin_compare(const void* a, const void* b);
void twin_signed(result* to, i64 value);
void twin_unsigned(result* to, u64 value);
void twin_real(result* to, f64 value);
void twin_single(result* to, f32 value);
i64 twin_clock(i64 moment);
u8 twin_character(const void* from, i64 room, i64 place, int line);
void twin_set_character(void* to, i64 place, u8 c, i64 most, int line);
u64 twin_to_bcd(u64 value, int digits, int line);
i64 twin_read_integer(const void* from, int line);
f64 twin_read_real(const void* from, int line);

u64* twin_put_bytes(u64* to, const void* from, i64 n);
u64* twin_put_text(u64* to, const void* from);
static inline u64* twin_put(u64* to, i64 value) { *to = (u64)value; return to + 1; }
static inline u64* twin_put_real(u64* to, f64 value) {
    if (value != value) *to = 0x7ff8000000000000u;
    else memcpy(to, &value, 8);
    return to + 1;
}

/* IEC 61131-3:2013, 6.6.3.5. */
struct ton { u8 in; i64 pt; u8 q; i64 et; u8 keeps_pt, answers_later; i64 preset; u8 running; i64 start; };
struct tof { u8 in; i64 pt; u8 q; i64 et; u8 keeps_pt, answers_later; i64 preset; u8 running; i64 start; };
struct tp { u8 in; i64 pt; u8 q; i64 et; u8 keeps_pt, answers_later; i64 preset; u8 before; i64 start; };
struct ctu { i64 data_type; u8 cu, r; i64 pv; u8 q; i64 cv; u8 stops_at_preset, cu_before; };
struct ctd { i64 data_type; u8 cd, ld; i64 pv; u8 q; i64 cv; u8 stops_at_preset, cd_before; };
struct ctud { i64 data_type; u8 cu, cd, r, ld; i64 pv; u8 qu, qd; i64 cv; u8 stops_at_preset, cu_before, cd_before; };
struct r_trig { u8 clk, q, last; };
struct f_trig { u8 clk, q, last; };
struct sr { u8 s1, r, q1; };
struct rs { u8 s, r1, q1; };
void call_ton(struct ton*);
void call_tof(struct tof*);
void call_tp(struct tp*);
void call_ctu(struct ctu*);
void call_ctd(struct ctd*);
void call_ctud(struct ctud*);
void call_r_trig(struct r_trig*);
void call_f_trig(struct f_trig*);
void call_sr(struct sr*);
void call_rs(struct rs*);

f64 Sleef_cinz_logd1_u10purec(f64);
f64 Sleef_cinz_log10d1_u10purec(f64);
f64 Sleef_cinz_expd1_u10purec(f64);
f64 Sleef_cinz_sind1_u10purec(f64);
f64 Sleef_cinz_cosd1_u10purec(f64);
f64 Sleef_cinz_tand1_u10purec(f64);
f64 Sleef_cinz_asind1_u10purec(f64);
f64 Sleef_cinz_acosd1_u10purec(f64);
f64 Sleef_cinz_atand1_u10purec(f64);
f64 Sleef_cinz_atan2d1_u10purec(f64, f64);
f64 Sleef_cinz_powd1_u10purec(f64, f64);

struct twin {
    void (*begin)(void);
    i64 (*scan)(const u64* inputs);
    u64* (*dump)(u64* to);
};
