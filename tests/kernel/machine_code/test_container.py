"""Containers of machine code: whatever is not as it was written is noticed before it is used."""

from __future__ import annotations

import pytest

from minirt.kernel.machine_code import container
from minirt.kernel.machine_code.container import HEADER, DamagedError, pack, unpack

KEY, OTHER_KEY = bytes(range(32)), bytes(32)
NAMES = {"function": "f", "defined": ["f", "g"]}
CODE = b"\x7fELF machine code"
DATA = pack(KEY, "a kernel", NAMES, CODE)


def is_refused(data: bytes, key: bytes = KEY, identity: str = "a kernel") -> bool:
    """Whether a container is found to be damaged."""
    try:
        unpack(key, identity, data)
    except DamagedError:
        return True
    return False


def with_flipped_bit(number: int) -> bytes:
    """Return the container with one bit changed."""
    changed = bytearray(DATA)
    changed[number // 8] ^= 1 << number % 8
    return bytes(changed)


def accepted_flips() -> list[int]:
    """Return the bits whose change is not noticed."""
    return [bit for bit in range(8 * len(DATA)) if not is_refused(with_flipped_bit(bit))]


def test_a_container_returns_what_was_put_in() -> None:
    assert unpack(KEY, "a kernel", DATA) == (NAMES, CODE)


def test_every_flipped_bit_is_noticed() -> None:
    assert accepted_flips() == []


def test_without_the_digest_flipped_bits_would_be_found_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(container.hmac, "compare_digest", lambda *_: True)
    last_of_code = 8 * len(DATA) - 1
    assert not is_refused(with_flipped_bit(last_of_code))


def test_every_shorter_and_longer_file_is_noticed() -> None:
    assert all(is_refused(DATA[:length]) for length in range(len(DATA)))
    assert is_refused(DATA + b"\0")


def test_a_container_of_another_kernel_is_noticed() -> None:
    assert is_refused(DATA, identity="another kernel")


def test_a_container_written_with_another_key_is_noticed() -> None:
    assert is_refused(DATA, key=OTHER_KEY)


def test_the_border_between_identity_and_content_cannot_move() -> None:
    content = DATA[HEADER.size :]
    first = container.digest(KEY, "a kernel", content)
    assert first != container.digest(KEY, "a kerne", b"l" + content)


@pytest.mark.parametrize("change", [{"MAGIC": b"anything"}, {"VERSION": container.VERSION + 1}])
def test_a_container_of_another_format_is_noticed(monkeypatch: pytest.MonkeyPatch, change: dict[str, object]) -> None:
    with monkeypatch.context() as patch:
        for name, value in change.items():
            patch.setattr(container, name, value)
        other = pack(KEY, "a kernel", NAMES, CODE)
    with pytest.raises(DamagedError, match="another format"):
        unpack(KEY, "a kernel", other)
