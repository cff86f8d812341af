"""Numbers as text."""
import math

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power(number, digits=3):
    """1e6 as 10⁶, others with so many digits."""
    if number > 0:
        exponent = math.log10(number)
        if (number >= 1e4 or number < 1e-2) and abs(exponent - round(exponent)) < 1e-9:
            return "10" + str(round(exponent)).translate(SUPERSCRIPTS)
    text = f"{number:.{digits}g}"
    if 1e-3 <= abs(number) < 1e5 or number == 0:
        return f"{float(text):.6g}"
    if "e" in text:
        digits, exponent = text.split("e")
        return digits + "·10" + str(int(exponent)).translate(SUPERSCRIPTS)
    return text
