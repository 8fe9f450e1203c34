"""Fresnel reflection of glass and mirrors: `fresnel:share`; `fresnel` alone is `fresnel:1`.

The shares of reflected and refracted light follow Fresnel's equations for unpolarised light: little is reflected where
one looks along the normal, all where one looks along the surface. `share` mixes them with the constant shares; at 0
these alone count.

Glass of the index n reflects ((n - 1) / (n + 1))^2 of the light along the normal, 4 % for 1.5, of the share that
`glass:` and `mirror:` have together; the rest of that share is refracted. A mirror that is no glass reflects its own
share along the normal and more elsewhere, as a transparent varnish of the index (1 + sqrt(share)) / (1 - sqrt(share))
does: `mirror:0.04` is a polished floor. A shape with neither `glass:` nor `mirror:` shows no difference.

    sp 0,0,20 8 255,255,255 glass:1.5 fresnel
"""

from __future__ import annotations

from functools import partial

from minirt.fields import Real

Fresnel = partial(Real, unit="ratio", low=0.0, high=1.0, step=0.1, placeholder="share", initial=1.0, feature="fresnel")
