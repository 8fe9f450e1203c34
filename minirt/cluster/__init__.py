"""Pictures and films on several processes or machines: bands and frames of the same bits, whoever renders them."""
