namespace semloop {}
