/* The bits of a number as an integer. */
static int64_t bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The number whose bits are those of an integer. */
static double number_of(int64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* An integer shifted to the right; the sign comes in from the left. */
static int64_t shifted_right(int64_t x, int64_t count)
{
    return x < 0 ? ~(~x >> count) : x >> count;
}

/* A number without its fraction; 0 for NaN, the nearest integer where it is out of range. */
static int64_t to_integer(double x)
{
    if (!(x == x)) {
        return 0;
    }
    return x >= 9223372036854775808.0 ? INT64_MAX : x <= -9223372036854775808.0 ? INT64_MIN : (int64_t)x;
}
