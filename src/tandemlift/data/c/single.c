/* Elementary functions in single precision, from the C library; limits as in tandemlift.compiler.tracer.elementary. */
static float elementary_exp(float x)
{
    return expf(x < -87.0f ? -87.0f : x > 88.0f ? 88.0f : x);
}

static float elementary_tanh(float x)
{
    return tanhf(x);
}

static float elementary_log(float x)
{
    return logf(x);
}

static void elementary_sin_cos(float x, float *sine, float *cosine)
{
    *sine = sinf(x);
    *cosine = cosf(x);
}

/* A zero of either sign is taken as +0. */
static float elementary_atan2(float y, float x)
{
    return atan2f(y == 0.0f ? 0.0f : y, x == 0.0f ? 0.0f : x);
}
