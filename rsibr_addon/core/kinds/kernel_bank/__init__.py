"""An environment filtered with the kernels that all lobes are sums of."""
