"""Where devices get their randomness: a stream of its own for each, that nothing else draws from."""

from __future__ import annotations

from hashlib import blake2b

from kit.kernels import kernels


def stream_of(seed: int, *names: str) -> int:
    """A stream's key, 0 to 2**63 - 1, from the world's seed and the names of the device."""
    text = "\0".join([str(seed), *names])
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") >> 1


class Noise:
    """Random numbers from one stream. Value ``i`` is always the same, whatever was drawn before."""

    def __init__(self, stream: int) -> None:
        self._stream = stream

    def uniform(self, index: int) -> float:
        """In [0, 1)."""
        return float(kernels.uniform(self._stream, index))

    def normal(self, index: int, deviation: float = 1.0) -> float:
        return float(deviation * kernels.normal(self._stream, index)) if deviation else 0.0
