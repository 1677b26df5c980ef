from typing import Any

class sht:
    @staticmethod
    def adjoint_synthesis_2d(**arguments: Any) -> Any: ...
    @staticmethod
    def synthesis_general(**arguments: Any) -> Any: ...
